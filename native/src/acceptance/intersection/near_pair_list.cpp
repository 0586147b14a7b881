// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/near_pair_list.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "acceptance/intersection/deviation_test.hpp"

namespace stiv {

namespace {

constexpr Index chunk_size = 8192;
constexpr double relative_reach = 0x1p-19;  // at least 16 units in the last place of single precision

/// Is a vertex of the primitive marked?
bool has_marked(const std::array<Index, 3>& corners, const std::vector<unsigned char>& marks) {
  return (marks[at(corners[0])] | marks[at(corners[1])] | marks[at(corners[2])]) != 0;
}

}  // namespace

/// Relative to the largest coordinate that may move, rounded up to a power of two, so that it seldom changes.
double NearPairList::reach_near(const PositionsView& q, const std::vector<unsigned char>& moved,
                                const Execution& execution) const {
  const auto count = static_cast<Index>(q.rows());
  std::vector<double> each(at(Execution::chunk_count(count, chunk_size)), 0);
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index chunk) {
    for (Index vertex = begin; vertex < end; ++vertex)
      if ((moved.empty() || moved[at(vertex)] != 0) && !surface_->is_fixed(vertex))
        each[at(chunk)] = std::max(each[at(chunk)], q.row(vertex).cwiseAbs().maxCoeff());
  });
  const double largest = each.empty() ? 0 : std::ranges::max(each);
  int exponent = 0;
  return std::frexp(largest, &exponent) == 0 ? 0 : std::ldexp(relative_reach, exponent);
}

std::vector<unsigned char> NearPairList::begin(const PositionsView& q, const std::vector<unsigned char>& moved,
                                               const Execution& execution, double least) {
  const double reach = std::max(reach_near(q, moved, execution), least);
  reach_ = moved.empty() ? reach : std::max(reach_, reach);
  if (moved.empty() || !is_complete_ || near_->reach != reach_) return {};
  std::vector<unsigned char> searched = moved;
  execution.for_chunks(static_cast<Index>(q.rows()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex)
      if (q.row(vertex) != accepted_->row(vertex)) searched[at(vertex)] = 1;
  });
  return searched;
}

void NearPairList::accept(const PositionsView& q, const std::vector<unsigned char>& searched, const Found& found,
                          const std::vector<unsigned char>& proofs, const Execution& execution) {
  is_complete_ = false;
  leave_to_test();
  std::erase_if(near_->pairs, [&](const CornerPair& pair) {
    return searched.empty() || has_marked(pair.first, searched) || has_marked(pair.second, searched);
  });
  std::ranges::copy_if(found.triangles, std::back_inserter(near_->pairs),
                       [this](const CornerPair& pair) { return !is_in_star(pair); });
  near_->pairs.insert(near_->pairs.end(), found.loose.begin(), found.loose.end());
  std::erase_if(near_->stars, [&](Index vertex) { return stars_->has_moved(vertex, searched); });
  const std::vector<Index> open = stars_->find_open(proofs, searched);
  near_->stars.insert(near_->stars.end(), open.begin(), open.end());
  near_->reach = reach_;
  accepted_->resize(q.rows(), 3);
  execution.for_chunks(static_cast<Index>(q.rows()), chunk_size, [&](Index begin, Index end, Index) {
    accepted_->middleRows(begin, end - begin) = q.middleRows(begin, end - begin);
  });
  is_complete_ = true;
}

/// The test reads its positions and pairs on any thread, for as long as it is used.
void NearPairList::leave_to_test() {
  if (!test_) return;
  near_ = std::make_shared<NearPairs>(*near_);
  accepted_ = std::make_shared<Positions>();
  test_.reset();
}

/// All triangles at a vertex with a link belong to its star.
bool NearPairList::is_in_star(const CornerPair& pair) const {
  return std::ranges::any_of(pair.first, [&](Index corner) {
    return std::ranges::find(pair.second, corner) != pair.second.end() && !stars_->link(corner).empty();
  });
}

std::shared_ptr<const DeviationTest> NearPairList::test_near(const PositionsView& q) const {
  if (!is_complete_ || accepted_->rows() != q.rows() || *accepted_ != q) return nullptr;
  if (!test_)
    test_ = std::make_shared<const DeviationTest>(
        std::make_unique<const DeviationTest::Implementation>(surface_, stars_, accepted_, near_));
  return test_;
}

}  // namespace stiv
