#include "core/geometry/mesh_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/scenes/dress_form.h"

using namespace weft;
namespace fs = std::filesystem;

namespace {

/// A folder of its own that goes with the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("weft_mesh_file_test_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

void write_mesh(const TriangleMesh& mesh, const fs::path& path) {
  std::ofstream(path, std::ios::binary) << encode_meshes({{"one", mesh}}, path);
}

TriangleMesh read_obj(const fs::path& path) {
  TriangleMesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3d p;
      words >> p[0] >> p[1] >> p[2];
      mesh.positions.push_back(p);
    } else if (kind == "f") {
      Triangle t;
      for (Index& i : t) {
        std::string corner;
        words >> corner;
        i = static_cast<Index>(std::stol(corner)) - 1;
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

TriangleMesh read_ply(const fs::path& path) {
  TriangleMesh mesh;
  std::ifstream file(path);
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string word, element;
    words >> word >> element;
    if (word == "element") words >> (element == "vertex" ? vertices : faces);
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    Vec3d p;
    file >> p[0] >> p[1] >> p[2];
    mesh.positions.push_back(p);
  }
  for (std::size_t t = 0; t < faces; ++t) {
    int corners = 0;
    Triangle triangle;
    file >> corners >> triangle[0] >> triangle[1] >> triangle[2];
    REQUIRE(corners == 3);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

void check_same(const TriangleMesh& wanted, const TriangleMesh& read) {
  REQUIRE(read.positions.size() == wanted.positions.size());
  REQUIRE(read.triangles == wanted.triangles);
  for (std::size_t i = 0; i < wanted.positions.size(); ++i)
    REQUIRE((read.positions[i] - wanted.positions[i]).cwiseAbs().maxCoeff() < 1e-6);
}

void check_same_triangles(const TriangleMesh& wanted, const TriangleMesh& read) {
  REQUIRE(read.triangles.size() == wanted.triangles.size());
  const auto corner = [](const TriangleMesh& mesh, std::size_t t, std::size_t k) {
    return mesh.positions.at(static_cast<std::size_t>(mesh.triangles[t][k]));
  };
  for (std::size_t t = 0; t < wanted.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      REQUIRE((corner(read, t, k) - corner(wanted, t, k)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

}  // namespace

TEST_CASE("a written mesh reads back within 1e-6 m: the same triangles, in PLY the same order") {
  const Folder folder;
  const TriangleMesh mesh = make_dress_form();
  write_mesh(mesh, folder.path / "form.obj");
  write_mesh(mesh, folder.path / "form.ply");
  const TriangleMesh obj = read_obj(folder.path / "form.obj");
  CHECK(obj.positions.size() == mesh.positions.size());
  check_same_triangles(mesh, obj);
  check_same(mesh, read_ply(folder.path / "form.ply"));
}

TEST_CASE("particles in one place stay two in PLY, and keep their triangles in OBJ") {
  const Folder folder;
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}},
                          {{0, 1, 2}, {3, 2, 4}}};
  write_mesh(mesh, folder.path / "two.ply");
  check_same(mesh, read_ply(folder.path / "two.ply"));
  write_mesh(mesh, folder.path / "two.obj");
  check_same_triangles(mesh, read_obj(folder.path / "two.obj"));
}

TEST_CASE("a name without a known ending is refused as `out`") {
  const TriangleMesh mesh = make_dress_form();
  for (const char* name : {"form.stl", "form", ".obj", "form.obj.gz"}) {
    INFO(name);
    try {
      encode_meshes({{"one", mesh}}, name);
      FAIL("accepted");
    } catch (const DefinitionError& error) {
      CHECK(error.field == "out");
    }
  }
}

namespace {

/// A tube of n columns about the z axis, whose last column is the first one turned by a full turn,
/// with uv, as an OBJ.
std::string tube(int n, double last_turn) {
  std::ostringstream text;
  text.precision(17);
  const auto vertex = [n](int ring, int column) { return ring * (n + 1) + column + 1; };
  for (int ring = 0; ring < 4; ++ring) {
    for (int column = 0; column <= n; ++column) {
      const double turn = column == n ? last_turn : 2 * std::numbers::pi * column / n;
      text << "v " << 1.3 + 0.05 * std::cos(turn) << " " << 0.05 * std::sin(turn) << " "
           << 0.02 * ring << "\nvt " << 0.3 * column / n << " " << 0.02 * ring << "\n";
    }
  }
  for (int ring = 0; ring < 3; ++ring) {
    for (int column = 0; column < n; ++column) {
      const int a = vertex(ring, column), b = a + 1, c = a + n + 1, d = c + 1;
      for (const auto& t : {std::array{a, b, d}, std::array{a, d, c}}) {
        text << "f";
        for (const int i : t) text << " " << i << "/" << i;
        text << "\n";
      }
    }
  }
  return text.str();
}

}  // namespace

TEST_CASE("a seam that rounding has opened is closed, with the uv of both of its sides") {
  constexpr int kColumns = 24;
  for (const double turn : {2 * std::numbers::pi, 2 * std::numbers::pi + 1e-7, -1e-7}) {
    const MeshFile file = read_mesh(tube(kColumns, turn), "tube.OBJ");
    CHECK(file.mesh.positions.size() == 4 * kColumns);
    CHECK(file.uv.size() == file.mesh.positions.size());
    REQUIRE(file.corner_uv.size() == file.mesh.triangles.size());
    double widest = 0;
    for (const CornerUv& corners : file.corner_uv) {
      for (std::size_t k = 0; k < 3; ++k)
        widest = std::max(widest, std::abs(corners[k][0] - corners[(k + 1) % 3][0]));
    }
    CHECK(widest == Approx(0.3 / kColumns).epsilon(1e-4));
  }
  // An opening of a hundredth of an edge is one.
  CHECK(read_mesh(tube(kColumns, 2 * std::numbers::pi - 2e-3), "tube.obj").mesh.positions.size() ==
        4 * (kColumns + 1));
}

TEST_CASE("sheets that lie a ten thousandth of an edge above each other stay two") {
  const std::string two =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e-4\nv 1 0 1e-4\nv 0 1 1e-4\nf 1 2 3\nf 4 5 6\n";
  CHECK(read_mesh(two, "two.obj").mesh.positions.size() == 6);
}
