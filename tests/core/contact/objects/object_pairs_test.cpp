#include "core/contact/objects/object_pairs.h"

#include <catch2/catch.hpp>

#include "core/contact/objects/mesh_shape.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"

using namespace weft;

namespace {

/// Each pair is of features that there are. @param cloth,mesh  how many
void check_pairs(const std::vector<ContactCandidate<float>>& pairs, std::size_t cloth,
                 std::size_t mesh) {
  for (const ContactCandidate<float>& pair : pairs) {
    REQUIRE(pair.cloth >= 0);
    REQUIRE(static_cast<std::size_t>(pair.cloth) < cloth);
    REQUIRE(pair.feature >= 0);
    REQUIRE(static_cast<std::size_t>(pair.feature) < mesh);
  }
}

}  // namespace

TEST_CASE("cloth that flies apart is paired with features that there are, however far it reaches") {
  for (const float speed : {0.0F, 1e3F, 1e12F, 1e25F}) {
    INFO(speed << " m/s");
    test::Particles<float> p;
    p.add_patch(4, 0.02, Vec3d(-0.03, 0.005, -0.03), 1e-3, 100, 100);
    p.state.v[5] = Vec3f(0, -speed, 0);
    ContactCloths<float> cloths;
    cloths.defs = {ContactDef{}};
    cloths.patches = make_patches(p.state.x, p.edges, p.triangles);
    cloths.thickness = static_cast<float>(cloths.defs[0].thickness);
    const ObjectShapes<float> shapes =
        object_shapes<float>({{"needle", MeshDef{test::needle(0.05, 0.1, 5)}}}, nullptr);
    const MeshShape<float>& mesh = *shapes.meshes[0];
    REQUIRE(mesh.triangles.size() % kFeatureLanes != 0);  // blocks have lanes without a feature
    Clearance<float> clearance;
    NearFeatures<float> near;
    ObjectPairs<float> pairs = object_pairs<float>(1, cloths.patches.list.size());
    ObjectMotion<float> motion;
    motion.tick_seconds = 1.0F / 60;
    measure_clearance(cloths, shapes, motion, p.state, 1.0F / 60, nullptr, clearance, p.profile);
    mark_near(cloths, clearance, near);
    take_to_own(shapes, p.state.x, near);
    collect_pairs(cloths, shapes, near, p.state.x, nullptr, clearance, pairs, p.profile);
    CHECK((speed == 0 || pairs.of_mesh[0].particles.size() >= mesh.triangles.size()));
    check_pairs(pairs.of_mesh[0].particles, p.state.x.size(), mesh.triangles.size());
    check_pairs(pairs.of_mesh[0].edges, p.edges.size(), mesh.edges.size());
    check_pairs(pairs.of_mesh[0].triangles, p.triangles.size(), mesh.positions.size());
  }
}
