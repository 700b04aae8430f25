#include <thread>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/world.h"

// The same bits for any number of threads, in Debug and Release, with gcc and clang. The hashes
// below change with every change of the physics; then they are taken anew from a run of this test,
// and what stays tested is that all builds agree on them.

using namespace weft;

namespace {

/// Runs chunks on two threads, odd and even ones.
class TwoThreads : public Executor {
 public:
  void run(int chunks, void (*work)(void*, int), void* context) override {
    const auto every_second = [&](int first) {
      for (int chunk = first; chunk < chunks; chunk += 2) work(context, chunk);
    };
    std::thread other([&] { every_second(1); });
    every_second(0);
    other.join();
  }
};

std::uint64_t hash_after(const std::string& scene, int ticks, Executor* executor) {
  World<float> world(make_scene(scene), {executor, nullptr});
  for (int tick = 0; tick < ticks; ++tick) world.step();
  return world.hash();
}

}  // namespace

TEST_CASE("objects that move leave the same hash with one and two threads") {
  TwoThreads two_threads;
  for (const std::string scene : {"turntable", "lift-sphere"})
    CHECK(hash_after(scene, 120, nullptr) == hash_after(scene, 120, &two_threads));
}

TEST_CASE("each scene has the same hash with one and two threads, and the golden one") {
  const auto [scene, golden] = GENERATE(table<std::string, std::uint64_t>({
      {"default", 0x49c204683f0295a6},
      {"curtain", 0x1507b3829ba2c29d},
      {"flag", 0xaf79877a302e5d92},
      {"drape-sphere", 0xdd8542bdf9e202a2},
      {"wall", 0xa34f12525f405789},
  }));
  INFO(scene);
  TwoThreads two_threads;
  const std::uint64_t alone = hash_after(scene, 60, nullptr);
  CHECK(alone == hash_after(scene, 60, &two_threads));
  CHECK(alone == golden);
}
