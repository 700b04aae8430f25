#include <algorithm>
#include <cstring>
#include <sstream>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/geometry/mesh_file.h"

using namespace weft;

namespace {

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

const TriangleMesh& brick() {
  static const TriangleMesh mesh = box_mesh(Vec3d(0.5, 0.25, 0.125));
  return mesh;
}

std::string as_obj(const TriangleMesh& mesh, bool with_uv = false) {
  std::ostringstream out;
  for (const Vec3d& p : mesh.positions) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  if (with_uv) {
    for (const Vec3d& p : mesh.positions) out << "vt " << p[0] + 1 << ' ' << p[1] + p[2] << '\n';
  }
  for (const Triangle& t : mesh.triangles) {
    out << 'f';
    for (const Index i : t) {
      out << ' ' << i + 1;
      if (with_uv) out << '/' << i + 1;
    }
    out << '\n';
  }
  return out.str();
}

std::string as_ply(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : mesh.positions) out << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const Triangle& t : mesh.triangles)
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return out.str();
}

Vec3d corner(const TriangleMesh& mesh, std::size_t t, std::size_t k) {
  return mesh.positions[static_cast<std::size_t>(mesh.triangles[t][k])];
}

std::string as_binary_stl(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d n = unit_normal(mesh, static_cast<Index>(t));
    for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(n[axis]));
    for (std::size_t k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(corner(mesh, t, k)[axis]));
    put(out, std::uint16_t(0));
  }
  return out;
}

std::string as_text_stl(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "solid brick\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d n = unit_normal(mesh, static_cast<Index>(t));
    out << "facet normal " << n[0] << ' ' << n[1] << ' ' << n[2] << "\nouter loop\n";
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = corner(mesh, t, k);
      out << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid brick\n";
  return out.str();
}

/// A node that is moved by (10, 0, 0) and holds the mesh.
std::string as_glb(const TriangleMesh& mesh) {
  std::string data;
  for (const Vec3d& p : mesh.positions)
    for (int axis = 0; axis < 3; ++axis)
      put(data, static_cast<float>(p[axis] - (axis == 0 ? 10 : 0)));
  const std::size_t indices_at = data.size();
  for (const Triangle& t : mesh.triangles)
    for (const Index i : t) put(data, static_cast<std::uint32_t>(i));
  std::ostringstream json;
  json << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
       << R"("nodes":[{"mesh":0,"translation":[10,0,0]}],)"
       << R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
       << R"("buffers":[{"byteLength":)" << data.size() << "}],"
       << R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << indices_at
       << R"(},{"buffer":0,"byteOffset":)" << indices_at << R"(,"byteLength":)"
       << data.size() - indices_at << "}],"
       << R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)"
       << mesh.positions.size() << R"(,"min":[-10.5,-0.25,-0.125],"max":[-9.5,0.25,0.125]},)"
       << R"({"bufferView":1,"componentType":5125,"type":"SCALAR","count":)"
       << 3 * mesh.triangles.size() << "}]}";
  std::string text = json.str();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  put(out, std::uint32_t(2));
  put(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + data.size()));
  put(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  put(out, static_cast<std::uint32_t>(data.size()));
  out += std::string("BIN\0", 4) + data;
  return out;
}

std::string refusal(std::string_view bytes, const std::string& name,
                    const MeshFileLimits& limits = {}) {
  try {
    read_mesh(bytes, name, limits);
  } catch (const DefinitionError& error) {
    CHECK(error.field == "mesh");
    CHECK(error.value == name);
    return error.limit;
  }
  return "accepted";
}

}  // namespace

TEST_CASE("the same brick comes out of OBJ, PLY, both kinds of STL, and GLB with a moved node") {
  const auto [name, bytes] = GENERATE(table<std::string, std::string>({
      {"brick.obj", as_obj(brick())},
      {"brick.ply", as_ply(brick())},
      {"brick.stl", as_binary_stl(brick())},
      {"text.stl", as_text_stl(brick())},
      {"brick.glb", as_glb(brick())},
  }));
  INFO(name);
  const MeshFile file = read_mesh(bytes, name);
  CHECK(file.mesh.positions.size() == 8);
  REQUIRE(file.mesh.triangles.size() == 12);
  for (std::size_t t = 0; t < 12; ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      CHECK((corner(file.mesh, t, k) - corner(brick(), t, k)).norm() < 1e-6);
  }
  CHECK(is_closed(file.mesh));
  CHECK(enclosed_volume(file.mesh) == Approx(8 * 0.5 * 0.25 * 0.125));
  CHECK(file.uv.empty());
}

TEST_CASE("uv come with their vertices") {
  const MeshFile file = read_mesh(as_obj(brick(), true), "brick.obj");
  REQUIRE(file.uv.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3d& p = file.mesh.positions[i];
    CHECK(file.uv[i][0] == Approx(p[0] + 1));
    CHECK(file.uv[i][1] == Approx(p[1] + p[2]).margin(1e-6));
  }
}

TEST_CASE("a vertex with several uv is one vertex, and each triangle keeps those of its corners") {
  // A strip of four triangles; from the third on, the lower edge begins anew in uv.
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 2 0\nv 1 2 0\n"
      "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 0 2\nvt 1 2\nvt 5 5\nvt 5 6\nvt 0 1\n";
  const std::string first = "f 1/1 2/2 4/4\nf 1/1 4/4 3/3\n";
  const MeshFile whole =
      read_mesh(vertices + first + "f 3/9 4/4 6/6\nf 3/3 6/6 5/5\n", "strip.obj");
  CHECK(whole.uv.size() == 6);
  CHECK(whole.corner_uv.empty());  // another number of the same uv is no seam
  const MeshFile cut = read_mesh(vertices + first + "f 3/7 4/8 6/6\nf 3/7 6/6 5/5\n", "strip.obj");
  CHECK(cut.mesh.triangles == whole.mesh.triangles);
  CHECK(cut.mesh.positions == whole.mesh.positions);
  CHECK(cut.uv == whole.uv);
  REQUIRE(cut.corner_uv.size() == 4);
  CHECK(cut.corner_uv[0] == CornerUv{{{0, 0}, {1, 0}, {1, 1}}});
  CHECK(cut.corner_uv[1] == CornerUv{{{0, 0}, {1, 1}, {0, 1}}});
  CHECK(cut.corner_uv[2] == CornerUv{{{5, 5}, {5, 6}, {1, 2}}});
  CHECK(cut.corner_uv[3] == CornerUv{{{5, 5}, {1, 2}, {0, 2}}});
}

TEST_CASE("a face without uv has all three in one place, and the others keep theirs") {
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 2 0\nv 1 2 0\n"
      "vt 1 1\nvt 2 1\nvt 1 2\nvt 2 2\nvt 1 3\nvt 2 3\n";
  const MeshFile file =
      read_mesh(vertices + "f 1 2 4\nf 1/1 4/4 3/3\nf 3/3 4/4 6/6\nf 3/3 6/6 5/5\n", "strip.obj");
  REQUIRE(file.uv.size() == 6);
  REQUIRE(file.corner_uv.size() == 4);
  const CornerUv& hole = file.corner_uv[0];
  CHECK((hole[0] == hole[1] && hole[1] == hole[2]));
  for (std::size_t t = 1; t < 4; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = corner(file.mesh, t, k);
      CHECK(file.corner_uv[t][k] == std::array<double, 2>{p[0] + 1, p[1] + 1});
      const auto i = static_cast<std::size_t>(file.mesh.triangles[t][k]);
      CHECK(file.uv[i] == file.corner_uv[t][k]);  // though the hole came first
    }
  }
}

TEST_CASE("polygons are cut into triangles of the same area; points and lines are left out") {
  const MeshFile file =
      read_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nv 6 6 6\nf 1 2 3 4\nl 5 6\np 5\n",
                "square.obj");
  CHECK(file.mesh.positions.size() == 4);
  CHECK(file.mesh.triangles.size() == 2);
  CHECK(surface_area(file.mesh) == Approx(1));
}

TEST_CASE("faces of any number of corners keep their order, vertices and uv") {
  // A triangle, an L whose first diagonal would pass through its inner corner, and a square.
  const std::string vertices =
      "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv -1 0 0\nv 2 2 0\n"
      "vt 0 0\nvt 2 0\nvt 2 1\nvt 1 1\nvt 1 2\nvt 0 2\nvt -1 0\nvt 2 2\n";
  const std::string faces = "f 1/1 6/6 7/7\nf 1/1 2/2 3/3 4/4 5/5 6/6\nl 1 8\nf 4/4 3/3 8/8 5/5\n";
  const MeshFile file = read_mesh(vertices + faces, "l.obj");
  REQUIRE(file.mesh.triangles.size() == 7);
  CHECK(file.mesh.triangles[0] == Triangle{0, 1, 2});
  CHECK(file.mesh.positions.size() == 8);
  CHECK(surface_area(file.mesh) == Approx(1 + 3 + 1));
  for (std::size_t t = 1; t < 7; ++t)
    CHECK(unit_normal(file.mesh, static_cast<Index>(t))[2] > 0.999);
  CHECK(file.corner_uv.empty());
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(file.uv[i][0] == file.mesh.positions[i][0]);
    CHECK(file.uv[i][1] == file.mesh.positions[i][1]);
  }
}

TEST_CASE("a polygon that cannot be cut is refused by the number and place of its face") {
  const auto hint = [](const std::string& face, const std::string& head = {}) {
    const std::string bytes = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 5 0\nv 7 0 0\n" + head +
                              "f 1 2 3\nl 1 2\n" + face + "\nf 1 3 4\n";
    try {
      read_mesh(bytes, "sheet.obj");
    } catch (const DefinitionError& error) {
      CHECK(error.limit == "polygons whose sides do not cross");
      return error.hint;
    }
    return std::string("accepted");
  };
  CHECK(hint("f 2 1 4 3") == "accepted");
  CHECK(hint("f 2 4 3 5 1", "o towel\n") == "face 2, with 5 corners, the first at (2, 0, 0)");
  CHECK(hint("o box\nf 6 4 2 3") == "face 2, with 4 corners, the first at (7, 0, 0)");
  // One with uv is not beside those without.
  CHECK(hint("vt 0 0\nf 1 2 3 4\no box\nf 6/1 4/1 2/1 3/1") ==
        "face 1 of its material, with 4 corners, the first at (7, 0, 0)");
}

TEST_CASE("a polygon without area is told, and its triangles are flat") {
  const MeshFile file =
      read_mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nf 1 4 5\nf 1 2 3 4\n", "row.obj");
  CHECK(file.mesh.triangles.size() == 3);
  CHECK(surface_area(file.mesh) == Approx(1.5));
  CHECK(file.flat_face == "face 2, with 4 corners, the first at (0, 0, 0)");
  CHECK(read_mesh(as_obj(brick()), "brick.obj").flat_face.empty());
}

TEST_CASE("numbers of an OBJ may lack the digit before their point, and its lines may go on") {
  const MeshFile whole =
      read_mesh("v 0 0 0.5\nv -0.5 0.25 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n", "a.obj");
  const MeshFile other =
      read_mesh("v 0 0 .5\nv -.5 .25 .0\nv 0 \\\n 1 0 # .x\nv 5 5 5\nf 1 2 \\\r\n3\n", "a.obj");
  CHECK(other.mesh.positions == whole.mesh.positions);
  CHECK(other.mesh.triangles == whole.mesh.triangles);
  CHECK_THROWS_AS(read_mesh("v 0 0 0,5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj"), DefinitionError);
  CHECK_THROWS_AS(read_mesh("", "a.obj"), DefinitionError);
}

TEST_CASE("files that are no whole mesh are refused by name, cut at any length") {
  CHECK(refusal("", "a.obj") != "accepted");
  CHECK(refusal("hello", "a.xyz") == "a name that ends in .obj, .ply, .stl or .glb");
  CHECK(refusal("v 0 0 0\nv 1 0 0\n", "points.obj") != "accepted");
  CHECK(refusal("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "nan.obj") != "accepted");
  CHECK(refusal("v 0 0 0\nv 1 0 0\nv 0 1e9 0\nf 1 2 3\n", "far.obj") != "accepted");
  CHECK(refusal("solid x", "8.stl") != "accepted");
  const std::string stl = as_binary_stl(brick()), glb = as_glb(brick());
  for (std::size_t size = 0; size < stl.size(); size += 7)
    CHECK(refusal(stl.substr(0, size), "cut.stl") != "accepted");
  for (std::size_t size = 0; size < glb.size(); size += 7)
    CHECK(refusal(glb.substr(0, size), "cut.glb") != "accepted");
}

TEST_CASE("a text may begin with a byte order mark") {
  const std::string mark = "\xEF\xBB\xBF";
  const MeshFile plain = read_mesh(as_obj(brick()), "brick.obj", {});
  const MeshFile marked = read_mesh(mark + as_obj(brick()), "brick.obj", {});
  CHECK(marked.mesh.positions == plain.mesh.positions);
  CHECK(marked.mesh.triangles == plain.mesh.triangles);
}

TEST_CASE("a PLY whose head counts more than the file can hold is refused for that") {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n";
  CHECK_THROWS_WITH(read_mesh(ply, "big.ply", {}), Catch::Contains("counts more"));
}

TEST_CASE("a file larger than its limits is refused with the limit") {
  const std::string obj = as_obj(brick());
  CHECK(refusal(obj, "brick.obj", {10, 100, 100}) == "at most 10 bytes");
  CHECK(refusal(obj, "brick.obj", {10000, 7, 100}) == "at most 7 vertices");
  CHECK(refusal(obj, "brick.obj", {10000, 100, 11}) == "at most 11 triangles");
  CHECK(refusal(obj, "brick.obj", {10000, 8, 12}) == "accepted");
}
