#include "core/geometry/mesh_file.h"

#include <filesystem>
#include <fstream>
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
  std::ofstream(path, std::ios::binary) << encode_mesh(mesh, path);
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
      encode_mesh(mesh, name);
      FAIL("accepted");
    } catch (const DefinitionError& error) {
      CHECK(error.field == "out");
    }
  }
}
