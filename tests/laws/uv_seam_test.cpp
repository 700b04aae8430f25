#include <cmath>
#include <map>
#include <tuple>

#include <catch2/catch.hpp>

#include "core/cloth/corner_places.h"
#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// Meshes whose (u, v) are cut along seams: the threads of each triangle are those of its own
// corners, and so is its rest shape. Closed forms of a tube and of a sheet from two pieces.

using namespace weft;
using test::Cut;

namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;

/// Unlike in both ways, so that threads in a wrong direction are seen in the energy.
void make_unlike(FabricDef& f) {
  f.stretch_warp = 600;
  f.stretch_weft = 150;
  f.shear = 20;
  f.poisson = 0.3;
  f.bending_warp = 2e-3;
  f.bending_weft = 5e-4;
}

/// A tube about the z axis whose (u, v) are a rectangle: cut along one line, where u begins again.
struct Tube {
  int around = 12, along = 5;  ///< facets
  double facet = 0.05;         ///< width of one in space [m]
  double fabric_facet = 0.05;  ///< the same in uv [m]
  double ring = 0.04;          ///< distance of rings, in space and in uv [m]
  double grain = 0;            ///< angle from the way round to the warp [rad]

  double radius() const { return facet / 2 / std::sin(kTurn / around / 2); }
  double inner_radius() const { return facet / 2 / std::tan(kTurn / around / 2); }
  double fabric_area() const { return around * along * fabric_facet * ring; }

  ClothDef cloth() const {
    ClothDef def;
    make_unlike(def.fabric);
    ClothMesh& tube = def.mesh.emplace();
    for (int r = 0; r <= along; ++r) {
      for (int k = 0; k < around; ++k) {
        const double angle = kTurn * k / around;
        tube.mesh.positions.emplace_back(radius() * std::cos(angle), radius() * std::sin(angle),
                                         ring * r);
        tube.uv.push_back(place(r, k));
      }
    }
    for (int r = 0; r < along; ++r) {
      for (int k = 0; k < around; ++k) {
        const auto at = [&](int row, int column) -> Index {
          return (r + row) * around + (k + column) % around;
        };
        tube.mesh.triangles.push_back({at(0, 0), at(0, 1), at(1, 1)});
        tube.corner_uv.push_back({place(r, k), place(r, k + 1), place(r + 1, k + 1)});
        tube.mesh.triangles.push_back({at(0, 0), at(1, 1), at(1, 0)});
        tube.corner_uv.push_back({place(r, k), place(r + 1, k + 1), place(r + 1, k)});
      }
    }
    return def;
  }

 private:
  std::array<double, 2> place(int r, int k) const {
    const double c = std::cos(grain), s = std::sin(grain);
    const double round = k * fabric_facet, up = r * ring;
    return {c * round - s * up, s * round + c * up};
  }
};

/// A sheet of two pieces beside each other, on whose right one the threads are turned by 90 degrees
/// and `u` runs backwards if it is mirrored.
ClothDef two_pieces(Cut cut, bool mirrored) {
  ClothDef sheet = test::triangle_sheet(cut, 0.4, 0.2, 0.02);
  make_unlike(sheet.fabric);
  ClothMesh& mesh = *sheet.mesh;
  if (cut == Cut::irregular) {
    for (std::size_t i = 0; i < mesh.uv.size(); ++i) {  // the seam is straight
      double& x = mesh.mesh.positions[i][0];
      if (std::abs(x - 0.2) < 0.006) x = 0.2;
      mesh.uv[i][0] = x;
    }
  }
  for (const Triangle& t : mesh.mesh.triangles) {
    CornerUv corners;
    double middle = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.uv[static_cast<std::size_t>(t[k])];
      middle += corners[k][0] / 3;
    }
    if (middle > 0.2) {
      for (auto& [u, v] : corners) std::tie(u, v) = std::tuple(mirrored ? -v : v, 5 - u);
    }
    mesh.corner_uv.push_back(corners);
  }
  return sheet;
}

Vec3Array<double> moved(const ClothModel<double>& model, Vec3d (*place)(const Vec3d&)) {
  Vec3Array<double> x;
  for (const Vec3d& p : model.rest_positions) x.push_back(place(p));
  return x;
}

constexpr double kStrain = 1e-5;

Vec3d wider_along_x(const Vec3d& p) {
  return {(1 + kStrain) * p[0], p[1], p[2]};
}
Vec3d curved_along_x(const Vec3d& p) {
  return {p[0], p[1], 0.5 * p[0] * p[0]};
}

std::string refused(const ClothDef& def) {
  try {
    build_cloth<double>(def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return {};
}

}  // namespace

TEST_CASE("the warp winds about a tube at one angle in each triangle, across the seam of its uv") {
  Tube tube;
  tube.grain = GENERATE(0.0, 0.5, 0.8);
  const double c = std::cos(tube.grain), s = std::sin(tube.grain);
  const ClothModel<double> model = build_cloth<double>(tube.cloth());
  REQUIRE(model.membrane.size() == 120);
  for (const MembraneTriangle<double>& t : model.membrane) {
    const auto x = [&](std::size_t k) {
      return model.rest_positions[static_cast<std::size_t>(t.x[k])];
    };
    const Vec3d warp = t.u1 * (x(1) - x(0)) + t.u2 * (x(2) - x(0));
    const Vec3d weft = t.v1 * (x(1) - x(0)) + t.v2 * (x(2) - x(0));
    const Vec3d outwards = (x(0) + x(1) + x(2)).cwiseProduct(Vec3d(1, 1, 0)).normalized();
    CHECK(warp[2] == Approx(-s).margin(1e-9));
    CHECK(weft[2] == Approx(c));
    CHECK(Vec3d::UnitZ().cross(outwards).dot(warp) > 0.9 * c);
  }
  // Of strains round and along the tube, and the shear of a twist.
  const auto energy = [&](double round, double along, double twist) {
    const double u = round * c * c + along * s * s - twist * s * c;
    const double v = round * s * s + along * c * c + twist * s * c;
    const double shear = 2 * (round - along) * s * c + twist * (c * c - s * s);
    return (300 * u * u + 75 * v * v + 0.3 * 150 * u * v + 10 * shear * shear) * kStrain * kStrain *
           tube.fabric_area();
  };
  const auto stretch = [&](double round, double along, double twist) {
    Vec3Array<double> x = model.rest_positions;
    for (Vec3d& p : x) {
      const double angle = twist * kStrain * p[2] / tube.inner_radius();
      const Vec3d wider((1 + round * kStrain) * p[0], (1 + round * kStrain) * p[1],
                        (1 + along * kStrain) * p[2]);
      p = Eigen::AngleAxisd(angle, Vec3d::UnitZ()) * wider;
    }
    return elastic_energy(model, x).stretch;
  };
  CHECK(stretch(1, 0, 0) == Approx(energy(1, 0, 0)).epsilon(1e-3));
  CHECK(stretch(0, 1, 0) == Approx(energy(0, 1, 0)).epsilon(1e-3));
  CHECK(stretch(0, 1, 1) == Approx(energy(0, 1, 1)).epsilon(1e-3));
}

TEST_CASE("springs and hinges of a tube are alike all round it, also at the seam of its uv") {
  ClothDef def = Tube().cloth();
  def.fabric.poisson = kPoissonOfGrid;
  def.membrane_model = MembraneModel::springs;
  def.bending_model = BendingModel::hinges;
  const ClothModel<double> model = build_cloth<double>(def);
  /// An edge's lower ring, how many it rises by, and how far it goes round.
  using Kind = std::tuple<long, long, long>;
  const auto kind_of = [&](Index i, Index j) -> Kind {
    const Vec3d &a = model.rest_positions[static_cast<std::size_t>(i)],
                &b = model.rest_positions[static_cast<std::size_t>(j)];
    const Vec3d &low = a[2] < b[2] ? a : b, &high = a[2] < b[2] ? b : a;
    const double turn =
        std::atan2(low[0] * high[1] - low[1] * high[0], low[0] * high[0] + low[1] * high[1]);
    const long rises = std::lround((high[2] - low[2]) / 0.04);
    const long round = std::lround(turn / kTurn * 12);
    return {std::lround(low[2] / 0.04), rises, rises == 0 ? std::abs(round) : round};
  };
  std::map<Kind, double> springs, hinges;
  for (const Spring<double>& s : model.springs)
    CHECK(s.stiffness == Approx(springs.try_emplace(kind_of(s.i, s.j), s.stiffness).first->second));
  for (const Hinge<double>& h : model.hinges)
    CHECK(h.stiffness ==
          Approx(hinges.try_emplace(kind_of(h.x[0], h.x[1]), h.stiffness).first->second));
  CHECK(springs.size() == 6 + 5 + 5);
  CHECK(hinges.size() == 4 + 5 + 5);
}

TEST_CASE("the links of a tube are alike all round it, also at the seam of its uv") {
  Tube tube;
  tube.grain = GENERATE(0.0, 0.5);
  const ClothModel<double> model = build_cloth<double>(tube.cloth());
  const ClothPart<double>& part = model.parts.front();
  REQUIRE(part.curved_at_rest);
  std::vector<double> weights(model.mass.size(), 0);
  for (const BendingLink& link : part.bending_links) {
    weights[static_cast<std::size_t>(link.i)] += std::abs(link.weight);
    weights[static_cast<std::size_t>(link.j)] += std::abs(link.weight);
  }
  std::map<long, double> of_ring;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const long ring = std::lround(model.rest_positions[i][2] / tube.ring);
    CHECK(weights[i] == Approx(of_ring.try_emplace(ring, weights[i]).first->second).epsilon(1e-6));
  }
  CHECK(of_ring.size() == 6);
}

TEST_CASE("each half of a sheet from two pieces stretches and bends as its own threads run") {
  const Cut cut = GENERATE(Cut::one_diagonal, Cut::alternating, Cut::irregular);
  const bool mirrored = GENERATE(false, true);
  INFO(test::name_of(cut) << ", mirrored " << mirrored);
  const ClothModel<double> model = build_cloth<double>(two_pieces(cut, mirrored));
  REQUIRE(model.hinges.empty());
  const double area = 0.4 * 0.2;
  CHECK(elastic_energy(model, moved(model, wider_along_x)).stretch ==
        Approx(0.5 * kStrain * kStrain * area * (600 + 150) / 2).epsilon(1e-6));
  CHECK(elastic_energy(model, moved(model, curved_along_x)).bending ==
        Approx(0.5 * area * (2e-3 + 5e-4) / 2).epsilon(1e-4));
}

namespace {

template <class T>
void check_same(const std::vector<T>& a, const std::vector<T>& b) {
  CHECK(a == b);
}

/// Every number that corners have a say in, and the order of all.
template <class Real>
void check_same_model(const ClothModel<Real>& a, const ClothModel<Real>& b) {
  const auto numbers = [](const ClothModel<Real>& m) {
    std::vector<double> list;
    const auto add = [&](auto... values) { (list.push_back(static_cast<double>(values)), ...); };
    for (const auto& [u, v] : m.material) add(u, v);
    for (std::size_t t = 0; t < m.triangles.size(); ++t) add(m.triangle_area[t]);
    for (const auto& s : m.springs) add(s.i, s.j, s.rest_length, s.stiffness, s.damping);
    for (const auto& h : m.hinges)
      add(h.x[0], h.x[1], h.x[2], h.x[3], h.rest_angle, h.stiffness, h.damping, h.smallest_normal2);
    for (const auto& t : m.membrane) add(t.x[0], t.x[1], t.x[2], t.u1, t.u2, t.v1, t.v2, t.area);
    for (const auto& l : m.locks) add(l.x[0], l.x[1], l.x[2], l.g1, l.g2, l.stiffness);
    for (const Real mass : m.mass) add(mass);
    const ClothPart<Real>& part = m.parts.front();
    for (const BendingLink& l : part.bending_links) add(l.i, l.j, l.weight);
    for (const Real pull : part.rest_curves.pulls) add(pull);
    add(part.bounds.membrane_omega2, part.bounds.bending_omega2, part.bounds.locking_omega2);
    return list;
  };
  check_same(a.triangles, b.triangles);
  check_same(a.rest_positions, b.rest_positions);
  check_same(a.start_positions, b.start_positions);
  check_same(numbers(a), numbers(b));
}

}  // namespace

TEMPLATE_TEST_CASE("where no vertex has several uv, those of corners change no bit", "", float,
                   double) {
  ClothDef sheet = test::triangle_sheet(Cut::irregular, 0.3, 0.2, 0.025, 0.5);
  make_unlike(sheet.fabric);
  const int kind = GENERATE(0, 1, 2, 3, 4);
  INFO(kind);
  if (kind == 1) {
    sheet.membrane_model = MembraneModel::springs;
    sheet.fabric.poisson = kPoissonOfGrid;
  } else {
    sheet.fabric.locking_strain = 0.02;
    sheet.fabric.locking_factor = 5;
  }
  if (kind == 2) sheet.bending_model = BendingModel::hinges;
  if (kind == 3) sheet.rest_shape = RestShape::uv;
  if (kind == 4) {
    for (Vec3d& p : sheet.mesh->mesh.positions) p[2] = 0.1 * std::sin(9 * p[0]);
  }
  ClothDef cornered = sheet;
  for (const Triangle& t : sheet.mesh->mesh.triangles) {
    CornerUv& corners = cornered.mesh->corner_uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = sheet.mesh->uv[static_cast<std::size_t>(t[k])];
  }
  const auto with = build_cloth<TestType>(cornered);
  CHECK(with.corner_material.size() == with.triangles.size());
  check_same_model(build_cloth<TestType>(sheet), with);
}

TEST_CASE("a tube whose uv are its rest shape has their strain, mass and bending at the seam too") {
  Tube tube;
  tube.fabric_facet = 0.04;  // it starts wider than its fabric is
  ClothDef def = tube.cloth();
  def.rest_shape = RestShape::uv;
  def.bending_model = BendingModel::hinges;
  const ClothModel<double> model = build_cloth<double>(def);
  const double area = tube.fabric_area(), strain = 0.05 / 0.04 - 1;
  double mass = 0;
  for (const double m : model.mass) mass += m;
  CHECK(mass == Approx(def.fabric.areal_density * area));
  const ElasticEnergy energy = elastic_energy(model, model.start_positions);
  CHECK(energy.stretch == Approx(0.5 * 600 * strain * strain * area));
  // Flat at rest: at each line along the tube the fabric is bent by the angle between facets.
  const double curvature = kTurn / tube.around / tube.fabric_facet;
  CHECK(energy.bending == Approx(0.5 * 2e-3 * curvature * curvature * area));
}

TEST_CASE("sewn from flat pieces a tube has the bending energy of its curvature, in theta^2") {
  for (const double grain : {0.0, 0.7}) {
    INFO("grain " << grain);
    double error[2];
    for (int k = 0; k < 2; ++k) {
      Tube tube;
      tube.around = k == 0 ? 15 : 30;
      tube.facet = tube.fabric_facet = 1.0 / tube.around;
      tube.ring = 0.8 * tube.facet;
      tube.along = tube.around;
      tube.grain = grain;
      ClothDef def = tube.cloth();
      def.rest_shape = RestShape::uv;
      const ClothModel<double> model = build_cloth<double>(def);
      CHECK(model.hinges.empty());
      const double c2 = std::pow(std::cos(grain), 2), s2 = 1 - c2;
      const double rigidity = 2e-3 * c2 * c2 + 5e-4 * s2 * s2 + (2e-3 + 5e-4) * s2 * c2;
      const double curvature = kTurn;  // of a tube that is one metre round
      error[k] = elastic_energy(model, model.start_positions).bending /
                     (0.5 * rigidity * curvature * curvature * tube.fabric_area()) -
                 1;
    }
    INFO("errors " << error[0] << " and " << error[1]);
    CHECK(std::abs(error[0]) < 0.03);
    CHECK(std::abs(error[1]) < 0.3 * std::abs(error[0]));
  }
}

TEST_CASE("what a tube that rests in its uv is built of does not depend on where it starts") {
  ClothDef def = Tube().cloth();
  def.rest_shape = RestShape::uv;
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  if (def.membrane_model == MembraneModel::springs) def.fabric.poisson = kPoissonOfGrid;
  ClothDef large = def;
  for (Vec3d& p : large.mesh->mesh.positions) p = 3 * p + Vec3d(1, 2, 0);
  ClothModel<double> model = build_cloth<double>(def), other = build_cloth<double>(large);
  CHECK(model.parts[0].bounds.bending_omega2 > 0);
  other.rest_positions = model.rest_positions;
  other.start_positions = model.start_positions;
  check_same_model(model, other);
}

TEST_CASE("a tube wider than its fabric shrinks to the circumference of its uv") {
  Tube tube;
  tube.fabric_facet = 0.045;
  ClothDef def = tube.cloth();
  def.rest_shape = RestShape::uv;
  World<double> world(test::empty_world(def));
  CHECK(test::settle(world, 20, 2) < 1e-3);
  double radius = 0;
  for (const Vec3d& x : world.state().x) radius += std::hypot(x[0], x[1]) / 72;
  CHECK(radius == Approx(0.9 * tube.radius()).epsilon(0.01));
}

TEST_CASE("a cloth with seams beside others keeps the places of its corners, and so do they") {
  const ClothDef tube = Tube().cloth();
  ClothDef grid = test::flat_cloth(4, 5);
  const std::vector<ClothDef> orders[] = {{tube, grid, tube}, {grid, tube, grid}};
  for (const std::vector<ClothDef>& cloths : orders) {
    const ClothModel<float> all = build_cloths<float>(cloths);
    REQUIRE(all.corner_material.size() == all.triangles.size());
    for (std::size_t k = 0; k < cloths.size(); ++k) {
      const ClothModel<float> alone = build_cloth<float>(cloths[k]);
      for (Index t = 0; t < all.parts[k].triangles.count; ++t)
        REQUIRE(corner_places(all, all.parts[k].triangles.first + t) == corner_places(alone, t));
    }
  }
}

TEST_CASE("uv of corners that cannot be used are refused by name") {
  const ClothDef good = Tube().cloth();
  CHECK(refused(good).empty());
  ClothDef def = good;
  def.mesh->corner_uv.pop_back();
  CHECK(refused(def) == "cloth.mesh.corner_uv");
  def = good;
  def.mesh->uv.clear();
  CHECK(refused(def) == "cloth.mesh.corner_uv");
  def = good;
  def.rest_shape = RestShape::uv;
  CHECK(refused(def).empty());
  def = good;
  def.mesh->corner_uv[7][1] = def.mesh->corner_uv[7][0];
  CHECK(refused(def).empty());  // projected instead
  def.rest_shape = RestShape::uv;
  CHECK(refused(def) == "cloth.rest_shape");
}
