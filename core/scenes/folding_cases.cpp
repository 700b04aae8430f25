#include <cassert>
// The fourth list of hard cases: cloth that hands fold and unfold.

#include <cmath>
#include <numbers>

#include "core/cloth/fabric_presets.h"
#include "core/scenes/hard_cases.h"

namespace weft {
namespace {

using std::numbers::pi;

/// Held points, as fractions of the fabric's extent.
struct Hold {
  double u, v;
};

/// Hands that carry the held points to the other side in a low arch, and let go there.
/// @param start    when they take hold [s]
/// @param seconds  duration of the motion [s]
/// @param displacement  to the place where they let go [m]
void take_over(WorldDef& def, const std::vector<Hold>& holds, double start, double seconds,
               const Vec3d& displacement) {
  assert(!holds.empty() && start >= 0 && seconds > 0);
  constexpr int kKeys = 20;
  constexpr double kHeld = 0.1, kArch = 0.15;  // arch: height per length of the displacement
  for (const Hold& hold : holds) {
    HandDef hand;
    hand.u = hold.u;
    hand.v = hold.v;
    hand.radius = 0.04;
    for (int k = 0; k <= kKeys; ++k) {
      const double fraction = 0.5 - 0.5 * std::cos(pi * k / kKeys), angle = pi * fraction;
      const Vec3d up(0, displacement.norm() * kArch * std::sin(angle), 0);
      hand.path.push_back(
          {start + seconds * k / kKeys, displacement * (0.5 - 0.5 * std::cos(angle)) + up});
    }
    hand.path.push_back({start + seconds + kHeld, displacement});
    def.hands.push_back(hand);
  }
}

/// A towel that is folded twice and unfolded twice; the last time by one hand in the middle of an
/// edge.
void build_towel(WorldDef& def, const std::string&) {
  constexpr double kSide = 0.8, kFolded = 0.97 * kSide;
  ClothDef& towel = def.cloths[0];
  towel = lying_cloth(33, kSide, 0.0041);
  towel.fabric = make_fabric("cotton");
  def.colliders = {ground()};
  def.environment.damping = 0.5;
  const std::vector<Hold> edge = {{0, 1}, {0.5, 1}, {1, 1}};
  const std::vector<Hold> both_layers = {{1, 0.03}, {1, 0.25}, {1, 0.75}, {1, 0.97}};
  take_over(def, edge, 0.5, 1.4, Vec3d(0, 0, -kFolded));
  take_over(def, both_layers, 2.4, 1.4, Vec3d(-kFolded, 0, 0));
  take_over(def, both_layers, 4.2, 1.4, Vec3d(kFolded, 0, 0));
  take_over(def, {{0.5, 1}}, 6, 2, Vec3d(0, 0, kSide));
  judge(def, 0.5);
  def.verdict.rest_at = 0.5;
  def.verdict.back_by = 9.9;
  def.verdict.heights = towel.fabric.thickness / 4;  // folded once, it is half a thickness higher
  def.verdict.hands_lag = 0.05;
}

}  // namespace

std::vector<SceneEntry> folding_cases() {
  return {
      {{"hard-towel",
        "Hands fold a towel twice and unfold it again, one hand alone at the end: it lies flat."},
       build_towel}};
}

}  // namespace weft
