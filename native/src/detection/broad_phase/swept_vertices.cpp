// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/swept_vertices.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>

#include "detection/broad_phase/common_boxes.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/coordinate_range.hpp"

namespace stiv {

namespace {

constexpr Index chunk_size = 2048;

const double* row(const PositionsView& positions, Index vertex) {
  return positions.data() + 3 * static_cast<std::ptrdiff_t>(vertex);
}

bool same_bits(const PositionsView& a, const PositionsView& b, Index vertex, Index count) {
  return std::memcmp(row(a, vertex), row(b, vertex), 3 * sizeof(double) * count) == 0;
}

/// A float not above `value`, or the least one. Conversion errs by at most half a unit in the last place, which |f|
/// 2^-23 covers; the smallest denormal does so around zero.
float round_down(double value) {
  using Limits = std::numeric_limits<float>;
  constexpr auto largest = static_cast<double>(Limits::max());
  const auto nearest = static_cast<float>(value < -largest ? -largest : value > largest ? largest : value);
  return std::max(nearest - (std::abs(nearest) * Limits::epsilon() + Limits::denorm_min()), Limits::lowest());
}

}  // namespace

/// Extent of the steps of some vertices.
struct SweptVertices::Survey {
  Vector3 low = Vector3::Constant(never), high = -low;
  bool valid = true;

  void include(const Survey& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    valid = valid && other.valid;
  }
  void include(const double* from, const double* to) {
    for (Index k = 0; k < 3; ++k) {
      low[k] = std::min({low[k], from[k], to[k]});
      high[k] = std::max({high[k], from[k], to[k]});
      valid = valid && is_valid_coordinate(from[k]) && is_valid_coordinate(to[k]);
    }
  }
};

// A pair is reported at most (1 + 1e-3) h + 9 * 2^-46 M apart (or where its own boxes overlap at that distance), with M
// no larger than the diameter of all coordinates. Each of two boxes is padded by more than half of that.
double SweptVertices::Frame::margin() const { return 0.55 * separation + 0x1p-42 * (2 * radius); }

bool SweptVertices::has_other_frame(const Step& step, Index vertex) const {
  const Index body = surface_.body_of(vertex);
  return step.motions.of_body(body) != motions_.of_body(body);
}

/// Vertices whose step differs from that of their box, or whose frame does but not the common one; ascending.
std::vector<Index> SweptVertices::changed_in(const Step& step, const Execution& execution) const {
  if (!complete_) {
    std::vector<Index> all(static_cast<std::size_t>(surface_.vertex_count()));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const Index count = surface_.vertex_count() - resting_;
  const bool frames_differ = step.motions.common == motions_.common && step.motions != motions_;
  std::vector<std::vector<Index>> parts(Execution::chunk_count(count, chunk_size));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index chunk) {
    constexpr Index run = 32;  // unchanged vertices mostly have unchanged neighbors
    const auto same = [&](Index first, Index number) {
      if (!same_bits(step.start, start_, first, number) || !same_bits(step.end, end_, first, number)) return false;
      for (Index k = 0; frames_differ && k < number; ++k)
        if (has_other_frame(step, first + k)) return false;
      return true;
    };
    for (Index some = begin; some < end; some += run) {
      const Index last = std::min(end, some + run);
      if (same(some, last - some)) continue;
      for (Index vertex = some; vertex < last; ++vertex)
        if (!same(vertex, 1)) parts[chunk].push_back(vertex);
    }
  });
  return concatenate<Index>(parts);
}

/// @throws InputError if a number is not finite or out of range
SweptVertices::Survey SweptVertices::survey(const Step& step, const Execution& execution) const {
  const auto count = static_cast<Index>(changed_.size());
  std::vector<Survey> parts(Execution::chunk_count(count, chunk_size));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index chunk) {
    Survey part;
    for (Index k = begin; k < end; ++k) part.include(row(step.start, changed_[k]), row(step.end, changed_[k]));
    parts[chunk] = part;
  });
  Survey whole;
  for (const Survey& part : parts) whole.include(part);
  if (!whole.valid) {
    surface_.check_positions(step.start);
    surface_.check_positions(step.end);
  }
  return whole;
}

/// The current frame if it is still suitable; with the common motion of this step.
SweptVertices::Frame SweptVertices::frame_for(const Step& step, const Survey& survey) const {
  Frame frame = frame_;
  frame.separation = step.proximity.separation;
  frame.motion = step.motions.common;
  if (changed_.empty()) return frame;
  const auto count = static_cast<double>(surface_.vertex_count()), changed = static_cast<double>(changed_.size());
  const bool reaches =
      (survey.high - frame.centre).maxCoeff() <= frame.radius && (frame.centre - survey.low).maxCoeff() <= frame.radius;
  if (reaches && changed < count / 2) return frame;
  Vector3 low = survey.low, high = survey.high;
  if (changed < count) {
    low = low.cwiseMin(frame.centre - Vector3::Constant(frame.radius));
    high = high.cwiseMax(frame.centre + Vector3::Constant(frame.radius));
  }
  const double radius = (high / 2 - low / 2).maxCoeff();
  if (reaches && frame.radius <= 8 * radius) return frame;
  frame.centre = low / 2 + high / 2;
  frame.radius = 2 * radius;
  return frame;
}

// Numbers of boxes are coordinates relative to the center, less a motion, with padding.
GroupFrames SweptVertices::body_frames() const {
  if (!motions_.has_own_frames()) return {};
  std::vector<Vector3> relative;
  double reach = 0;
  for (const Vector3& motion : motions_.of_bodies) {
    relative.emplace_back(motion - motions_.common);
    reach = std::max(reach, motion.lpNorm<Eigen::Infinity>());
  }
  reach = std::max(reach, motions_.common.lpNorm<Eigen::Infinity>());
  return {relative, 4 * (reach + frame_.radius + frame_.separation)};
}

PackedBox SweptVertices::box(const Step& step, Index vertex) const {
  const double *from = row(step.start, vertex), *to = row(step.end, vertex);
  const Vector3& own_motion = motions_.of_body(surface_.body_of(vertex));
  double start[3], end[3], reach = 0;
  bool moves = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    start[k] = from[k] - frame_.centre[axis];
    const double target = to[k] - frame_.centre[axis];
    end[k] = target - own_motion[axis];
    reach = std::max({reach, std::abs(end[k] - start[k]), std::abs(target - frame_.motion[axis] - start[k])});
    moves |= from[k] != to[k];
  }
  const double padding = frame_.margin() + slack * reach;
  PackedBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.values[k] = round_down(std::min(start[k], end[k]) - padding);
    box.values[k + 3] = round_down(-std::max(start[k], end[k]) - padding);
  }
  box.values[6] = moves ? -1.0F : 1.0F;
  box.values[7] = 0;
  return box;
}

/// Is the start that of the vertex's box, and is the end within the slack of the segment? In the frame of the body for
/// its boxes and for pairs within it, in the common frame for other pairs.
bool SweptVertices::near_segment(const Step& step, Index vertex) const {
  if (vertex < changing() && !same_bits(step.start, start_, vertex, 1)) return false;
  const Index body = surface_.body_of(vertex);
  const Vector3 &own = motions_.of_body(body), &own_of_step = step.motions.of_body(body);
  const bool has_own_frame = own != motions_.common || own_of_step != step.motions.common;
  return (!has_own_frame || near_segment(step, vertex, own, own_of_step)) &&
         near_segment(step, vertex, motions_.common, step.motions.common);
}

/// The same in a frame with one motion for the boxes, and another one for the step.
bool SweptVertices::near_segment(const Step& step, Index vertex, const Vector3& frame_motion,
                                 const Vector3& step_motion) const {
  const Vector3 start = step.start.row(vertex), end = step.end.row(vertex);
  const Vector3 end_of_box = vertex < changing() ? Vector3(end_.row(vertex)) : end;
  const Vector3 motion = end_of_box - start - frame_motion, other = end - start - step_motion;
  const double length2 = motion.squaredNorm();
  const bool may_move = boxes_[vertex].active() || start == end;
  if (!(length2 > 0) || !may_move) return false;
  const double along = std::clamp(other.dot(motion) / length2, 0.0, 1.0);
  const double aside = (other - along * motion).lpNorm<Eigen::Infinity>();
  const double size = start.lpNorm<1>() + end.lpNorm<1>() + step_motion.lpNorm<1>() + frame_motion.lpNorm<1>();
  return aside + 0x1p-49 * size <= 0.999 * slack * motion.lpNorm<Eigen::Infinity>();  // all rounding allowed for
}

/// Boxes and coarse steps in the common frame, of the steps taken last. Returns the largest reach of coarse steps.
std::int32_t SweptVertices::make_boxes(std::span<const Index> vertices) {
  const Vector3 &centre = frame_.centre, &motion = frame_.motion, end = centre + motion;
  const CommonFrame frame{{centre[0], centre[1], centre[2], 0},
                          {motion[0], motion[1], motion[2], 0},
                          {end[0], end[1], end[2], 0},
                          frame_.margin(),
                          slack,
                          coarse_frame_.in_units(1)};
  return make_common_boxes(frame, steps_.data(), vertices, boxes_.data(), coarse_steps_.data());
}

/// The same in the frames of bodies.
std::int32_t SweptVertices::make_framed_boxes(const Step& step, std::span<const Index> vertices) {
  std::int32_t reach = 0;
  for (const Index vertex : vertices) {
    boxes_[vertex] = box(step, vertex);
    coarse_steps_[vertex] = coarse_frame_.step(row(step.start, vertex), row(step.end, vertex));
    reach = std::max(reach, coarse_steps_[vertex].reach());
  }
  return reach;
}

void SweptVertices::sweep(const Step& step, const std::vector<Index>& vertices, const Execution& execution) {
  const auto count = static_cast<Index>(vertices.size());
  std::vector<std::int32_t> reaches(Execution::chunk_count(count, chunk_size));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index chunk) {
    const std::span<const Index> some(vertices.data() + begin, vertices.data() + end);
    reaches[chunk] = motions_.has_own_frames() ? make_framed_boxes(step, some) : make_boxes(some);
    for (const Index vertex : some) {
      if (vertex >= changing()) break;
      start_.row(vertex) = step.start.row(vertex);
      end_.row(vertex) = step.end.row(vertex);
    }
  });
  for (const std::int32_t reach : reaches) coarse_reach_ = std::max(coarse_reach_, reach);
}

/// Do the boxes contain the step in frames with its motions? False for numbers that are not finite.
bool SweptVertices::holds(const Step& step, const Execution& execution) const {
  if (step.proximity.separation != frame_.separation) return false;
  const bool all = step.motions.common != motions_.common;
  const auto count = all ? surface_.vertex_count() : static_cast<Index>(changed_.size());
  std::atomic<bool> near{true};
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end && near.load(std::memory_order_relaxed); ++k)
      if (!near_segment(step, all ? k : changed_[k])) near.store(false, std::memory_order_relaxed);
  });
  return near;
}

/// Vertices whose step equals that of their box, now and in the last step, are up to date. Valid also if cancelled.
void SweptVertices::take_steps(const Step& step, const Execution& execution) {
  if (!complete_) {
    steps_.update(step.start, step.end, execution);
    outdated_.clear();
    return;
  }
  steps_.update(step.start, step.end, outdated_, execution);
  outdated_.insert(outdated_.end(), changed_.begin(), changed_.end());
  steps_.update(step.start, step.end, changed_, execution);
  outdated_ = std::vector<Index>(changed_);  // without the capacity of both
}

/// Are both ends of the step within an eighth of the separation of a surface, and are the boxes of all vertices that
/// move active? Differences of coordinates have relative errors, which the remaining gaps cover.
bool SweptVertices::stays_near(const Positions& surface, const Step& step, const Execution& execution) const {
  const double reach = frame_.separation / 8;
  std::atomic<bool> near{true};
  execution.for_chunks(surface_.vertex_count(), chunk_size, [&](Index begin, Index end, Index) {
    bool all = near.load(std::memory_order_relaxed);
    for (Index vertex = begin; vertex < end && all; ++vertex) {
      const double *const from = row(step.start, vertex), *const to = row(step.end, vertex);
      const double* const place = vertex < changing() ? row(surface, vertex) : from;
      bool moves = false;
      for (std::size_t k = 0; k < 3; ++k) {
        all &= std::abs(from[k] - place[k]) <= reach && std::abs(to[k] - place[k]) <= reach;
        all &= is_valid_coordinate(from[k]) && is_valid_coordinate(to[k]);
        moves |= from[k] != to[k];
      }
      all &= !moves || boxes_[vertex].active();
    }
    if (!all) near.store(false, std::memory_order_relaxed);
  });
  return near;
}

bool SweptVertices::take_short_step(const PositionsView& start, const PositionsView& end, const Execution& execution) {
  const Step step{start, end, {}, motions_};
  if (!complete_ || !(frame_.separation > 0)) return false;
  if (!stays_near(start_, step, execution) && !stays_near(end_, step, execution)) return false;
  changed_ = changed_in(step, execution);
  take_steps(step, execution);
  return true;
}

SweptVertices::Change SweptVertices::update(const Step& step, const Execution& execution, Reuse reuse) {
  const Index count = surface_.vertex_count();
  changed_ = changed_in(step, execution);
  if (complete_ && reuse == Reuse::allowed && holds(step, execution)) {
    take_steps(step, execution);
    return Change::none;
  }
  const Frame frame = frame_for(step, survey(step, execution));
  take_steps(step, execution);
  const bool all = !complete_ || frame != frame_;
  complete_ = false;  // until the end: this may be cancelled
  frame_ = frame;
  motions_ = step.motions;
  coarse_frame_ = CoarseFrame(frame.centre, frame.motion, frame.radius);
  if (all) {
    boxes_.resize(count);
    coarse_steps_.resize(count);
    coarse_reach_ = 0;
    start_.resize(changing(), 3);
    end_.resize(changing(), 3);
    if (static_cast<Index>(changed_.size()) < count) {
      changed_.resize(count);
      std::iota(changed_.begin(), changed_.end(), 0);
    }
  }
  sweep(step, changed_, execution);
  outdated_.clear();
  complete_ = true;
  if (all || static_cast<Index>(changed_.size()) > count / 2) return Change::all;
  changed_bodies_.assign(surface_.bodies().size(), 0);
  for (const Index vertex : changed_) changed_bodies_[surface_.body_of(vertex)] = 1;
  return Change::some;
}

}  // namespace stiv
