#include <cmath>
#include <iostream>

#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

// A sheet that is pulled along and pushed together across wrinkles. Wrinkles as wide as bending
// wants would have to rise more steeply from the held ends than the tension lets them: Cerda and
// Mahadevan 2003, lambda = 2 sqrt(pi) (B / T)^(1/4) L^(1/2).

using namespace weft;

namespace {

constexpr unsigned kSeed = 17;  ///< of what shakes it out of its plane
constexpr double kPi = 3.14159265358979323846;

struct Sheet {
  double rigidity, tension;  // [N m], [N/m]
  double length = 0.5;       // [m]

  double wavelength() const {
    return 2 * std::sqrt(kPi) * std::pow(rigidity / tension, 0.25) * std::sqrt(length);
  }
};

constexpr int kWaves = 8, kColumnsPerWave = 12, kRows = 33;
constexpr double kStretch = 2000, kShear = 20;  // [N/m]

ClothDef cloth_of(const Sheet& sheet) {
  ClothDef cloth;
  cloth.rows = kRows;
  cloth.columns = kWaves * kColumnsPerWave + 1;
  cloth.width = kWaves * sheet.wavelength();
  cloth.height = sheet.length;
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d::UnitZ();
  cloth.fabric.areal_density = 1;
  cloth.fabric.stretch_warp = cloth.fabric.stretch_weft = kStretch;
  cloth.fabric.shear = kShear;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = sheet.rigidity;
  return cloth;
}

/// Pulls the cloth along v to its tension, pushes it together along u with `push` [N/m], holds all
/// of its border and shakes the rest out of its plane.
void tighten(World<double>& world, const Sheet& sheet, double push) {
  // Both strains from the fabric's tensor: C11 = C22 = stretch, C12 = shear.
  const double determinant = kStretch * kStretch - kShear * kShear;
  const double across = (-push * kStretch - sheet.tension * kShear) / determinant;
  const double along = (sheet.tension * kStretch + push * kShear) / determinant;
  const ClothPart<double>& part = world.model().parts[0];
  test::Random random(test::seed_or(kSeed));
  for (int r = 0; r < part.rows; ++r) {
    for (int c = 0; c < part.columns; ++c) {
      const bool border = r == 0 || c == 0 || r + 1 == part.rows || c + 1 == part.columns;
      const auto i = static_cast<std::size_t>(r * part.columns + c);
      Vec3d& x = world.state().x[i];
      x[0] *= 1 + across;
      x[1] = border ? 0 : random.uniform(-1e-5, 1e-5);
      x[2] *= 1 + along;
    }
  }
  for (int r = 0; r < part.rows; ++r) {
    for (int c = 0; c < part.columns; ++c) {
      if (r == 0 || c == 0 || r + 1 == part.rows || c + 1 == part.columns)
        world.pin({r * part.columns + c, 0});
    }
  }
}

struct Wrinkles {
  double wavelength = 0;  ///< of the strongest harmonic of the middle row [m]
  double height = 0;      ///< of that harmonic [m]
  double share = 0;       ///< of the middle row's energy that it has
};

Wrinkles measured(const World<double>& world, double width) {
  const ClothPart<double>& part = world.model().parts[0];
  const int cells = part.columns - 1;
  Wrinkles best;
  double all = 0;
  for (int m = 1; m < cells; ++m) {
    double sum = 0;
    for (int c = 1; c < cells; ++c) {
      const auto i = static_cast<std::size_t>(part.rows / 2 * part.columns + c);
      sum += world.state().x[i][1] * std::sin(kPi * m * c / cells);
    }
    const double height = std::abs(2 * sum / cells);
    all += height * height;
    if (height > best.height) best = {2 * width / m, height, 0};
  }
  best.share = best.height * best.height / all;
  return best;
}

}  // namespace

TEST_CASE("a stretched sheet wrinkles with lambda = 2 sqrt(pi) (B/T)^(1/4) L^(1/2), to 10 %") {
  // cloth_B1em5_T50_L0p5: 53.0 mm; sixteen times the rigidity over the tension doubles it, and so
  // does twice the length under a quarter of the tension.
  const auto [sheet, expected] =
      GENERATE(table<Sheet, double>({{{1e-5, 50}, 0.053008734114448446},
                                     {{1.6e-4, 50}, 0.106017468228896892},
                                     {{1e-5, 12.5, 1}, 0.10601746822889689},
                                     {{4e-5, 12.5}, 0.106017468228896892}}));
  CHECK(sheet.wavelength() == Approx(expected).epsilon(1e-12));
  const test::Repeatable repeatable(test::seed_or(kSeed));
  WorldDef def = test::empty_world(cloth_of(sheet));
  def.tick_rate = 1000;
  World<double> world(def);
  // The plane is stable up to the first of these.
  const double critical = 2 * kPi / sheet.length * std::sqrt(sheet.rigidity * sheet.tension);
  tighten(world, sheet, 3 * critical);
  const double speed = test::settle(world, 20, 6);
  const Wrinkles wrinkles = measured(world, def.cloths[0].width);
  std::cout << "B " << sheet.rigidity << " N m, T " << sheet.tension << " N/m, L " << sheet.length
            << " m: wavelength " << wrinkles.wavelength << " m for " << expected << ", height "
            << wrinkles.height << " m, share " << wrinkles.share << ", speed " << speed
            << std::endl;
  CHECK(wrinkles.wavelength == Approx(expected).epsilon(0.1));
  CHECK(wrinkles.share > 0.5);
  CHECK(wrinkles.height > 1e-4);
}
