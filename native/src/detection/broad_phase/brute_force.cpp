// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>

#include "detection/broad_phase/relevance.hpp"

namespace stiv {

namespace {

/// All pairs: the oracle of the other sources.
class BruteForce final : public CandidateSource {
 public:
  explicit BruteForce(const Surface& surface) : surface_(surface) {}

  void update(const Step& step, const Execution& execution) override {
    surface_.check_positions(step.start);
    surface_.check_positions(step.end);
    steps_.update(step.start, step.end, execution);
    relevance_.emplace(surface_, step);
  }

  const VertexSteps& vertex_steps() const override { return steps_; }

  Index chunk_count(EventKind kind) const override { return Execution::chunk_count(firsts(kind), chunk_size); }

  void visit(EventKind kind, Index chunk, const Sink& sink) const override {
    std::vector<Candidate> candidates;
    const Index end = std::min(firsts(kind), (chunk + 1) * chunk_size);
    for (Index first = chunk * chunk_size; first < end; ++first) {
      candidates.clear();
      for (Index second = kind == EventKind::vertex_face ? 0 : first + 1; second < seconds(kind); ++second)
        candidates.push_back({first, second});
      sink(relevance_->select(kind, candidates));
    }
  }

 private:
  static constexpr Index chunk_size = 16;

  Index firsts(EventKind kind) const {
    return kind == EventKind::vertex_face ? surface_.vertex_count() : static_cast<Index>(surface_.edges().rows());
  }
  Index seconds(EventKind kind) const {
    return static_cast<Index>(kind == EventKind::vertex_face ? surface_.triangles().rows() : surface_.edges().rows());
  }

  const Surface& surface_;
  VertexSteps steps_;
  std::optional<Relevance> relevance_;
};

}  // namespace

std::unique_ptr<CandidateSource> make_brute_force(const Surface& surface) {
  return std::make_unique<BruteForce>(surface);
}

}  // namespace stiv
