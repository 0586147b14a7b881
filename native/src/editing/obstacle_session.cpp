// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/obstacle_session.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "editing/effective_separation.hpp"
#include "editing/motion_box.hpp"
#include "editing/near_session.hpp"
#include "editing/scene_rows.hpp"
#include "editing/validation.hpp"
#include "large_array.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr int boxes_per_call = 4;  // then all obstacles are near, which bounds the number of repetitions
// If this many more ticks of a drag leave the box, the next one is prepared. That takes many free ticks, or a third of
// them with contacts.
constexpr double free_ticks_ahead = 21, contact_ticks_ahead = 12;

void check_given(const Surface* surface, const Deformation* deformation, const Obstacles& obstacles) {
  if (surface == nullptr || deformation == nullptr) throw InputError("a surface and a deformation are needed");
  check_fit(*surface, *deformation);
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    if (!obstacles[k]) throw InputError("obstacle " + std::to_string(k) + ": none given");
}

/// Only elements of the surface may be excluded or overlap: of an obstacle, a session knows no closed body.
void check_without_obstacles(const EditOptions& options, const Surface& surface) {
  const auto triangles = static_cast<Index>(surface.triangles().rows());
  for (const auto& [a, b] : options.excluded)
    if (std::max(a, b) >= triangles)
      throw InputError("exclude: triangle " + std::to_string(std::max(a, b)) + " is not one of the surface's " +
                       std::to_string(triangles) + "; pairs with obstacles cannot be excluded");
  check_overlapping(surface, options.overlapping);
  check_touching(surface, options.touching);
}

std::vector<Index> named_bodies(const EditOptions& options, std::size_t bodies) {
  std::vector<Index> named;
  for (const BodyPairSeparation& pair : options.pair_separations) {
    for (const Index body : {pair.first, pair.second}) {
      check_body(body, bodies);
      named.push_back(body);
    }
  }
  return named;
}

class ObstacleSession final : public SessionImplementation {
 public:
  ObstacleSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                  const Controls& controls, EditOptions options, Obstacles obstacles, Execution& execution)
      : surface_((check_given(surface.get(), deformation.get(), obstacles), std::move(surface))),
        deformation_(std::move(deformation)),
        start_(controls),
        options_(std::move(options)),
        obstacles_(std::move(obstacles)),
        named_bodies_(named_bodies(options_, surface_->bodies().size() + obstacles_.size())),
        goal_(controls) {
    check_without_obstacles(options_, *surface_);
    const Eigen::AlignedBox3d bounds = moving_bounds(*surface_, deformation_->surface_in_range(controls, execution));
    open(around(bounds), controls, controls, execution);
    if (!is_inside(bounds)) open(whole_space(), controls, controls, execution);
    bounds_ = bounds;
  }

  EditResult edit(const Controls& goal, Execution& execution) override {
    return carry_out(goal, execution, [&] { return near_->session->edit(goal, execution); });
  }
  EditResult drag(const Controls& goal, Execution& execution, std::optional<double> hand_over) override {
    if (!reuse_) reuse_.emplace();
    EditResult result = carry_out(goal, execution, [&] { return near_->session->drag(goal, execution, hand_over); });
    if (result.status != EditStatus::cancelled) look_ahead(!result.events.empty(), execution.threads());
    return result;
  }
  EditResult settle(Execution& execution) override {
    const Controls goal = goal_;
    return carry_out(goal, execution, [&] { return near_->session->settle(execution); });
  }
  EditResult confirm(Execution& execution) override {
    const Controls goal = goal_;
    return carry_out(goal, execution, [&] { return near_->session->confirm(execution); });
  }

  void restore(const Controls& controls, const Controls& goal) override {
    // The session refuses other controls.
    const bool is_valid = controls.rows() == start_.rows() && controls.allFinite();
    Execution execution(options_.threads);
    const Eigen::AlignedBox3d bounds =
        is_valid ? moving_bounds(*surface_, deformation_->surface_in_range(controls, execution))
                 : Eigen::AlignedBox3d();
    if (is_inside(bounds))
      with_scene_numbers(near_->scene, controls, [&] { near_->session->restore(controls, goal); });
    else
      open(around(bounds), controls, goal, execution);
    bounds_ = bounds;
    goal_ = goal;
    motion_.setZero();
    forget_others();
  }

  void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) override {
    next_.reset();  // its thread reads the options
    near_->session->set_weights(weights, weight_axes);
    options_.weights = std::move(weights);
    options_.weight_axes = std::move(weight_axes);
    bounds_ = moving_bounds(*surface_, surface());
  }

  void end_drag() override {
    forget_others();
    near_->session->end_drag();
  }

  bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) override {
    for (const PositionsView* q : {&start, &end}) surface_->check_positions(*q);
    Eigen::AlignedBox3d bounds = moving_bounds(*surface_, start);
    bounds.extend(moving_bounds(*surface_, end));
    const auto test = [&](NearSession& near) { return near.session->is_step_free(start, end, execution); };
    if (is_inside(bounds)) return test(*near_);
    return test(*make_near(grown(bounds, margin()), start_, start_, execution));
  }

  std::shared_ptr<const DeviationTest> deviation_test() const override { return nullptr; }

  std::optional<NearestTriangles> least_distance(DistancePairs pairs) override {
    auto nearest = near_->session->least_distance(pairs);
    if (nearest)
      for (Index& triangle : nearest->triangles) triangle = near_->scene.whole_number(triangle);
    // A triangle outside of the box may be closer than the nearest one inside.
    if (nearest && contains(box_, moving_bounds(*surface_, surface()), nearest->distance)) return nearest;
    return stiv::least_distance(surface_, obstacles_, surface(), pairs, Execution(options_.threads));
  }

  const Controls& controls() const override { return near_->session->controls(); }
  const Positions& surface() const override { return near_->session->surface(); }
  double separation() const override { return near_->session->separation(); }
  const IndexPairs& excluded() const override { return near_->session->excluded(); }
  const Surface& topology() const override { return *surface_; }

 private:
  Eigen::AlignedBox3d around(const Eigen::AlignedBox3d& bounds) const {
    const Eigen::AlignedBox3d box =
        box_around(bounds, motion_, obstacles_, static_cast<Index>(surface_->triangles().rows()));
    return bounds.isEmpty() ? box : grown(box, 2 * options_.separation);
  }

  double margin() const {
    double separation = near_->session->separation();
    for (const BodyPairSeparation& pair : options_.pair_separations) separation = std::max(separation, pair.separation);
    return 2 * separation;
  }

  bool is_inside(const Eigen::AlignedBox3d& bounds) const { return contains(box_, bounds, margin()); }

  std::unique_ptr<NearSession> make_near(const Eigen::AlignedBox3d& box, const Controls& accepted, const Controls& goal,
                                         Execution& execution) const {
    NearScene scene = near_scene(*surface_, obstacles_, box, named_bodies_, execution);
    return with_scene_numbers(scene, accepted, [&] {
      auto session = make_surface_session(scene.surface, std::move(scene.obstacles), deformation_, start_,
                                          options_in(scene), accepted, goal, execution);
      return std::make_unique<NearSession>(NearSession{std::move(scene), std::move(session)});
    });
  }

  /// The options with the numbers of the scene's bodies.
  EditOptions options_in(const NearScene& scene) const {
    EditOptions options = options_;
    for (BodyPairSeparation& pair : options.pair_separations) {
      for (Index* body : {&pair.first, &pair.second}) {
        const auto place = std::ranges::lower_bound(scene.obstacle_bodies, *body);
        if (*body >= own_bodies()) *body = own_bodies() + static_cast<Index>(place - scene.obstacle_bodies.begin());
      }
    }
    return options;
  }

  Index own_bodies() const { return static_cast<Index>(surface_->bodies().size()); }

  /// Opens a session in a box, with the start of this one, and continues from accepted controls. If it throws, nothing
  /// has changed.
  void open(const Eigen::AlignedBox3d& box, const Controls& accepted, const Controls& goal, Execution& execution) {
    previous_.reset();
    exchange_near(box, make_near(box, accepted, goal, execution));
  }

  void exchange_near(const Eigen::AlignedBox3d& box, std::unique_ptr<NearSession> near) {
    previous_ = std::exchange(near_, std::move(near));
    box_ = box;
    next_.reset();
  }

  /// Frees all memory but that of the open session.
  void forget_others() {
    next_.reset();
    previous_.reset();
    reuse_.reset();
  }

  bool is_next(const Eigen::AlignedBox3d& box) const {
    return next_->box().min() == box.min() && next_->box().max() == box.max();
  }

  /// The prepared session, from a state that the open one has accepted. So all pairs within the surface, and those
  /// with the triangles that touch the present box, have passed the exact test at the same positions. No other triangle
  /// of an obstacle can meet the surface, because that lies inside the present box. Nothing is left to be tested.
  std::unique_ptr<NearSession> take_next(const Controls& accepted, const Controls& goal, Execution& execution) {
    auto near = next_->take(execution);
    near->session->restore_free(accepted, goal);
    return near;
  }

  /// The box of the prepared session if it contains the bounds, and otherwise a new one.
  Eigen::AlignedBox3d next_around(const Eigen::AlignedBox3d& bounds) const {
    return next_ && contains(next_->box(), bounds, margin()) ? next_->box() : around(bounds);
  }

  /// Prepares the session in the next box of a drag that is about to leave the present one. Which box depends on
  /// accepted states alone, and not on the number of threads.
  void look_ahead(bool has_contacts, int threads) {
    const double ticks_ahead = has_contacts ? contact_ticks_ahead : free_ticks_ahead;
    if (!options_.excluded.empty() || !options_.overlapping.empty()) return;  // compared with where a session began
    const Eigen::AlignedBox3d& now = bounds_;
    if (now.isEmpty() || is_inside(after(now, ticks_ahead))) return;
    if (next_ && contains(next_->box(), after(now, 1), margin())) return;
    next_.reset();
    const Eigen::AlignedBox3d box = around(now);
    if (!contains(box, after(now, ticks_ahead), margin())) return;  // a motion so fast would leave it at once
    next_.emplace(box, threads,
                  [this, box, accepted = controls(), goal = goal_,
                   previous = std::move(previous_)](Execution& execution) mutable {
                    previous.reset();
                    return make_near(box, accepted, goal, execution);
                  });
  }

  /// Bounds that some more ticks like the last one would sweep.
  Eigen::AlignedBox3d after(Eigen::AlignedBox3d bounds, double ticks) const {
    return bounds.extend(bounds.translated(ticks * motion_));
  }

  /// Makes a call, and again in other boxes while its path leaves the box.
  template <class Call>
  EditResult carry_out(const Controls& goal, Execution& execution, const Call& call) {
    const Controls before = controls(), goal_before = goal_;
    const Eigen::AlignedBox3d start = bounds_;
    Eigen::AlignedBox3d bounds = start.isEmpty() ? start : after(start, 1);
    if (!is_inside(bounds)) reopen(next_around(bounds), before, goal_before, execution);
    EditResult result = call();
    for (int boxes = 1; result.status != EditStatus::cancelled; ++boxes) {
      bounds_ = moving_bounds(*surface_, result.surface);
      const Eigen::AlignedBox3d path = bounds_of_path(result);
      if (is_inside(path)) break;
      bounds.extend(path);
      bounds_ = start;
      reopen(boxes < boxes_per_call ? next_around(bounds) : whole_space(), before, goal_before, execution);
      result = call();  // returns at once if it was cancelled
    }
    if (result.status != EditStatus::cancelled) goal_ = goal;
    if (!start.isEmpty()) motion_ = bounds_.center() - start.center();
    return with_scene_numbers(std::move(result));
  }

  /// Opens a session within a call, or restores the open one if that is cancelled. The time budget of the call must not
  /// end this, because the next call would begin alike.
  void reopen(const Eigen::AlignedBox3d& box, const Controls& accepted, const Controls& goal, Execution& of_call) {
    Execution execution(options_.threads);
    execution.cancel_when([&] { return of_call.cancel_requested(); });
    try {
      if (next_ && is_next(box))
        exchange_near(box, take_next(accepted, goal, execution));
      else
        open(box, accepted, goal, execution);
    } catch (...) {
      near_->session->restore(accepted, goal);
      if (!of_call.cancel_requested()) throw;
    }
  }

  /// Bounds of all states of a result, the last of which are `bounds_`. Between them, the surface moves linearly.
  Eigen::AlignedBox3d bounds_of_path(const EditResult& result) const {
    const Execution execution(options_.threads);
    Eigen::AlignedBox3d bounds = bounds_;
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k)
      bounds.extend(moving_bounds(*surface_, deformation_->surface_in_range(result.path[k], execution)));
    return bounds;
  }

  EditResult with_scene_numbers(EditResult result) const {
    const Index first = surface_->vertex_count();
    for (Event& event : result.events)
      for (Index& vertex : event.vertices)
        if (vertex >= first) vertex = near_->scene.obstacle_vertices[at(vertex - first)];
    for (Index& body : result.blocking)
      if (body >= own_bodies()) body = near_->scene.obstacle_bodies[at(body - own_bodies())];
    return result;
  }

  /// Calls work, which may find that controls intersect; then the error gets the numbers of all obstacles' triangles.
  template <class Work>
  auto with_scene_numbers(const NearScene& scene, const Controls& controls, const Work& work) const
      -> decltype(work()) {
    try {
      return work();
    } catch (StartIntersectsError& error) {
      Execution execution(options_.threads);
      const Positions near = rows_of_obstacles(scene.obstacle_vertices);
      SceneRows rows(near);
      StaticPairs found = IntersectionTest(scene.surface)
                              .find_all(rows.with_rest(deformation_->surface_in_range(controls, execution)), execution);
      found.faces = std::move(error.pairs);
      const auto name_face = [&](Index face) { return describe_face(face, scene); };
      const std::string message = describe(*scene.surface, found, name_face);
      for (auto& [a, b] : found.faces) a = scene.whole_number(a), b = scene.whole_number(b);
      throw StartIntersectsError(message, std::move(found.faces));
    }
  }

  /// @param vertices numbered as if all obstacles followed the surface, ascending
  Positions rows_of_obstacles(const std::vector<Index>& vertices) const {
    Positions rows(static_cast<Index>(vertices.size()), 3);
    auto obstacle = obstacles_.begin();
    Index first = surface_->vertex_count(), row = 0;
    for (const Index vertex : vertices) {
      while (vertex - first >= (*obstacle)->positions().rows())
        first += static_cast<Index>((*obstacle++)->positions().rows());
      rows.row(row++) = (*obstacle)->positions().row(vertex - first);
    }
    return rows;
  }

  std::string describe_face(Index face, const NearScene& scene) const {
    const auto own = static_cast<Index>(surface_->triangles().rows());
    if (face < own) return surface_->describe_triangle(face);
    Index number = scene.whole_number(face) - own;
    std::size_t k = 0;
    for (; number >= obstacles_[k]->triangles().rows(); ++k)
      number -= static_cast<Index>(obstacles_[k]->triangles().rows());
    return "object \"" + obstacles_[k]->name() + "\", face " + std::to_string(number);
  }

  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const Deformation> deformation_;
  Controls start_;
  EditOptions options_;
  Obstacles obstacles_;
  std::vector<Index> named_bodies_;   ///< by options
  Controls goal_;                     ///< of the last call
  Vector3 motion_ = Vector3::Zero();  ///< of the bounds in the last call
  Eigen::AlignedBox3d bounds_;        ///< of the accepted surface
  Eigen::AlignedBox3d box_;
  std::optional<MemoryReuse> reuse_;  ///< from one box to the next, until a drag ends
  std::unique_ptr<NearSession> near_;
  std::shared_ptr<NearSession> previous_;  ///< in the last box; freed by the thread that prepares the next one
  std::optional<NextSession> next_;        ///< last: its thread refers to the other members
};

}  // namespace

std::unique_ptr<SessionImplementation> make_obstacle_session(std::shared_ptr<const Surface> surface,
                                                             std::shared_ptr<const Deformation> deformation,
                                                             const Controls& controls, EditOptions options,
                                                             Obstacles obstacles, Execution& execution) {
  return std::make_unique<ObstacleSession>(std::move(surface), std::move(deformation), controls, std::move(options),
                                           std::move(obstacles), execution);
}

}  // namespace stiv
