// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/detector.hpp"

#include "detection/pair_search.hpp"

namespace stiv {

Detector::Detector(std::shared_ptr<const Surface> surface, DetectorOptions options)
    : search_(std::make_unique<PairSearch>(std::move(surface), options)) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;

void Detector::prepare(const PositionsView& start, Proximity proximity, Execution& execution) {
  const FloatingPointScope floating_point;
  search_->surface().check_positions(start);
  search_->prepare({start, start, proximity}, execution);
}

Events Detector::find(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution) {
  return *search_->find({start, end, proximity}, PairLimit::ignored, execution);
}

double Detector::earliest_time(const PositionsView& start, const PositionsView& end, Proximity proximity,
                               Execution& execution) {
  return *search_->earliest_time({start, end, proximity}, PairLimit::ignored, execution);
}

std::optional<Events> Detector::find_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                                       Proximity proximity, Execution& execution) {
  return search_->find({start, end, proximity}, PairLimit::respected, execution);
}

std::optional<double> Detector::earliest_time_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                                                Proximity proximity, Execution& execution) {
  return search_->earliest_time({start, end, proximity}, PairLimit::respected, execution);
}

const Surface& Detector::surface() const { return search_->surface(); }

}  // namespace stiv
