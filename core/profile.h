#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

// Time and work of a step's stages.

namespace weft {

/// The stages of a step, in the order of a substep; then those of the seed's components.
enum class Stage : std::uint8_t {
  attachments,     ///< work: hand forces evaluated
  fans,            ///< work: fans' jets evaluated at a particle (their time is part of air)
  air,             ///< triangles evaluated
  stretch,         ///< work: springs evaluated
  bending,         ///< work: hinges evaluated
  integration,     ///< work: particles kicked and moved
  broad_phase,     ///< work: candidate pairs collected
  pairs,           ///< work: features of near patches of cloths tested against each other
  narrow_phase,    ///< work: closest points computed
  regions,         ///< work: particles of cloths anchored
  contact,         ///< work: contact rows solved
  friction,        ///< work: friction evaluations (their time is part of contact)
  diagnostics,     ///< work: checks made
  relaxation,      ///< work: springs relaxed, over all sweeps (solver relaxation)
  self_contact,    ///< work: pairs of the cloth with itself answered, over all passes (model seed)
  linear_systems,  ///< work: iterations of conjugate gradients (solver implicit)
};
inline constexpr std::size_t kStageCount = 16;

inline constexpr std::array<const char*, kStageCount> kStageNames = {
    "attachments", "fans",       "air",          "stretch",       "bending", "integration",
    "broad_phase", "pairs",      "narrow_phase", "regions",       "contact", "friction",
    "diagnostics", "relaxation", "self_contact", "linear_systems"};

class StageTimer;

struct StageProfile {
  double seconds = 0;      ///< by the given clock; 0 without one
  std::uint64_t work = 0;  ///< amount of work; the same on every machine
};

/// Profile of one tick. The work counts are part of the physics and repeatable; the seconds are for
/// people and never decide anything.
struct Profile {
  std::array<StageProfile, kStageCount> stages{};
  double (*clock)() = nullptr;    ///< seconds from any origin, supplied by the owner; may be null
  StageTimer* running = nullptr;  ///< the innermost; null between steps

  StageProfile& operator[](Stage stage) {
    assert(static_cast<std::size_t>(stage) < kStageCount);
    return stages[static_cast<std::size_t>(stage)];
  }
  const StageProfile& operator[](Stage stage) const {
    return stages[static_cast<std::size_t>(stage)];
  }
  /// Between steps.
  void clear() {
    assert(running == nullptr);
    stages = {};
  }
};

/// Times its own lifetime for a stage and counts its work. The lifetime of a nested timer counts
/// for the nested stage only.
class StageTimer {
 public:
  StageTimer(Profile& profile, Stage stage, std::size_t work) : profile_(profile), stage_(stage) {
    profile_[stage_].work += work;
    if (!profile_.clock) return;
    outer_ = profile_.running;
    profile_.running = this;
    start_ = profile_.clock();
    if (outer_) outer_->book(start_);
  }
  ~StageTimer() {
    if (!profile_.clock) return;
    assert(profile_.running == this && "timers end in the reverse order of their start");
    const double end = profile_.clock();
    book(end);
    if (outer_) outer_->start_ = end;
    profile_.running = outer_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  void book(double until) { profile_[stage_].seconds += until - start_; }

  Profile& profile_;
  Stage stage_;
  StageTimer* outer_ = nullptr;
  double start_ = 0;
};

}  // namespace weft
