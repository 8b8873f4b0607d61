#pragma once
// A Scene as the tables that shaders read: records packed as shaders/shared/scene.h says, lengths and light scaled by
// powers of two so that the numbers are of order 1 (undone exactly at read-back). Pure CPU work, no device.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/bvh.h"
#include "engine/scene/instances.h"
#include "engine/scene/scene.h"
#include "shaders/shared/scene.h"
#include "shaders/shared/variant.h"

namespace scene
{

// What occurs in a scene; the rest is left out of the shaders.
struct SceneFeatures {
#define DECLARE_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) TYPE NAME = false;
    SCENE_FEATURES(DECLARE_FEATURE)
#undef DECLARE_FEATURE
    bool blend = false; // surfaces that exist by chance: equal rays may meet others in another frame
};

// What the tables and shaders provide for: what the scene needs, or everything. The picture is the same.
enum class FeatureSet { Needed, Everything };

struct LightCounts {
    uint64_t emissiveTriangles = 0;
    uint64_t points = 0;
    uint64_t spots = 0;
    uint64_t directionals = 0;
    uint64_t environments = 0;
};

struct SceneTables {
    Bvh bvh;            // of what lies in the world
    MeshTables meshes;  // with a scene that has instances
    PlaceTables places; // likewise
    std::vector<glm::uvec4> attributes;
    std::vector<glm::uvec4> texels;
    std::vector<glm::uvec4> environment; // of table SceneData the first rows: the environment's
    std::vector<glm::uvec4> sceneData;   // and those that follow
    shared::SceneUniform uniform = {};
    SceneFeatures features;
    LightCounts lights;
    double lengthScale = 1;   // scaled length = length * lengthScale; a power of two
    double radianceScale = 1; // scaled radiance = radiance * radianceScale; a power of two
};

// Throws Error when a table would exceed `maxTableBytes`.
SceneTables makeSceneTables(const Scene& scene, uint64_t maxTableBytes,
                            const std::function<void(double)>& bvhProgress = {},
                            FeatureSet featureSet = FeatureSet::Needed);

// Rows that a pose's tables have at most.
struct TableSizes {
    uint32_t nodes = 0, triangles = 0, attributes = 0, sceneData = 0;
    uint32_t placeNodes = 0, placeRecords = 0;
    uint32_t depth = 0;                                          // of any tree but that over instances
    uint32_t meshNodes = 0, meshRecords = 0, meshAttributes = 0; // which all poses share
};

TableSizes sizesOf(const SceneTables& tables);

// Of all trees but that over instances; the cost is that of what lies in the world.
BvhStats statsOf(const SceneTables& tables);

// While the tree's version stays, tables differ from pose to pose in these rows alone, and in those of SceneData and
// places.
struct TableChanges {
    MovingBvh::Changes tree;
    std::vector<RowRange> attributes;
};

// The tables of a scene that moves, pose by pose. In all of them lengths and light are scaled as at rest, and what the
// shaders provide for is what any pose may need.
class MovingTables
{
  public:
    // As makeSceneTables(), of Scene::motion's scene at rest; the limit is that of tables which hold two poses.
    MovingTables(const Scene& rest, uint64_t maxTableBytes, const std::function<void(double)>& bvhProgress = {},
                 FeatureSet featureSet = FeatureSet::Needed);
    MovingTables(const MovingTables& other);
    MovingTables& operator=(const MovingTables&) = delete;
    ~MovingTables();

    // Of what pose() has made of the scene; until the next call. Texels, environment and meshes are those of rest in
    // all poses.
    const SceneTables& at(const Scene& posed);
    const SceneTables& last() const; // of the last pose; first, of rest
    void forgetShared();             // texels and meshes: once they are on the device
    const TableChanges& changes() const;
    const TableSizes& most() const;

  private:
    struct Kept;
    std::unique_ptr<Kept> kept_;
};

} // namespace scene
