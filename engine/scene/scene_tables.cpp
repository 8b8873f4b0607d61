#include "engine/scene/scene_tables.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/scene/attribute_tables.h"
#include "engine/scene/light_tables.h"
#include "engine/scene/material_tables.h"
#include "engine/scene/motion.h"
#include "shaders/shared/bvh.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace scene
{

namespace
{

// 2^-round(log2(size)): brings `size` near 1 without rounding anything.
double powerOfTwoScale(double size)
{
    return size > 0 && std::isfinite(size) ? std::exp2(-std::round(std::log2(size))) : 1;
}

double radiusOf(const Scene& scene)
{
    double squared = squaredRadiusOfInstances(scene, boxesOf(scene.meshes));
    for (const Triangle& triangle : scene.triangles)
        for (const uint32_t vertex : triangle.vertices) {
            const glm::dvec3 p(scene.positions[vertex]);
            squared = std::max(squared, glm::dot(p, p));
        }
    return std::sqrt(squared);
}

SceneFeatures everything()
{
    SceneFeatures features{.blend = true};
#define ADD_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) features.NAME = true;
    SCENE_FEATURES(ADD_FEATURE)
#undef ADD_FEATURE
    return features;
}

uint32_t attributeRows(const SceneFeatures& features)
{
    if (features.HAS_SECOND_UV || features.HAS_VERTEX_COLORS) return shared::ATTRIBUTE_ROWS_FULL;
    const bool textured = features.HAS_BASE_COLOR_TEXTURE || features.HAS_METALLIC_ROUGHNESS_TEXTURE ||
                          features.HAS_NORMAL_MAP || features.HAS_EMISSIVE_TEXTURE ||
                          features.HAS_TRANSMISSION_TEXTURE || features.HAS_SPECULAR_TEXTURE;
    return textured ? shared::ATTRIBUTE_ROWS_UV : shared::ATTRIBUTE_ROWS_BARE;
}

void requireFits(const char* what, uint64_t rows, uint64_t maxTableBytes)
{
    if (rows * sizeof(glm::uvec4) > maxTableBytes)
        throw Error("The scene's {} need {} bytes, more than the device's limit of {} for one table.", what,
                    rows * sizeof(glm::uvec4), maxTableBytes);
}

glm::vec3 scaled(const glm::vec3& position, double scale)
{
    return glm::vec3(glm::dvec3(position) * scale);
}

std::vector<glm::vec3> scaled(const std::vector<glm::vec3>& positions, double scale)
{
    std::vector<glm::vec3> list(positions.size());
    for (size_t i = 0; i < list.size(); ++i) list[i] = scaled(positions[i], scale);
    return list;
}

// Which triangles traversal asks whether they exist; empty: none.
std::vector<uint8_t> alphaTests(const Scene& scene, const SceneFeatures& features)
{
    std::vector<uint8_t> tests;
    if (!features.HAS_ALPHA) return tests;
    for (const Triangle& triangle : scene.triangles)
        tests.push_back(scene.materials[triangle.material].alpha != Alpha::Opaque);
    return tests;
}

SceneFeatures featuresOf(SceneFeatures features, const Scene& scene, const LightTables& lights, FeatureSet featureSet)
{
    if (featureSet == FeatureSet::Everything) return everything();
    features.HAS_INSTANCES = !scene.instances.empty();
    features.HAS_EMISSIVE = !lights.emitters.empty();
    features.HAS_PUNCTUAL = lights.counts.points + lights.counts.spots > 0;
    features.HAS_DIRECTIONAL = lights.counts.directionals > 0;
    features.HAS_ENVIRONMENT = lights.counts.environments > 0;
    return features;
}

// Materials and lights: the rows of SceneData that differ from pose to pose.
void fillSceneData(SceneTables& tables, const LightTables& lights, const std::vector<glm::uvec4>& materials,
                   double radius)
{
    tables.lights = lights.counts;
    tables.sceneData.clear();
    shared::SceneUniform& uniform = tables.uniform;
    const auto append = [&](const std::vector<glm::uvec4>& rows) {
        const uint64_t offset = tables.environment.size() + tables.sceneData.size();
        tables.sceneData.insert(tables.sceneData.end(), rows.begin(), rows.end());
        return uint32_t(offset);
    };
    uniform.materialOffset = append(materials);
    uniform.lightOffset = append(lights.lights);
    uniform.punctualOffset = append(lights.punctual);
    uniform.instanceOffset = append(tables.places.rows);
    uniform.flatTriangles = tables.places.flatTriangles;
    uniform.triangleBits = tables.meshes.triangleBits;
    uniform.lightCount = lights.shine ? uint32_t(lights.lights.size()) : 0;
    uniform.environmentPick = lights.environmentPick;
    uniform.radius = float(radius * tables.lengthScale);
}

// All but the tree of what lies in the world. With `moves`, triangles are there twice on the device.
SceneTables tablesOf(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale, double radius,
                     const LightTables& lights, MaterialTables materials, bool moves, uint64_t maxTableBytes,
                     FeatureSet featureSet)
{
    SceneTables tables;
    tables.lengthScale = lengthScale;
    tables.radianceScale = lights.radianceScale;
    tables.features = featuresOf(materials.features, scene, lights, featureSet);
    tables.texels = std::move(materials.texels);
    const bool black =
        tables.features.HAS_ENVIRONMENT && lights.environment.empty(); // asked for, but the scene has none
    tables.environment = black ? std::vector<glm::uvec4>{glm::uvec4(0)} : lights.environment;
    tables.uniform.environmentOffset = 0;
    tables.uniform.environmentAliasOffset = uint32_t(tables.environment.size());
    tables.environment.insert(tables.environment.end(), lights.environmentAliases.begin(),
                              lights.environmentAliases.end());
    tables.uniform.environmentWidth = black ? 1 : scene.environment.width;
    tables.uniform.environmentHeight = black ? 1 : scene.environment.height;
    tables.uniform.attributeRows = attributeRows(tables.features);
    requireFits("textures", tables.texels.size(), maxTableBytes);
    const uint32_t rows = tables.uniform.attributeRows;
    requireFits("triangles", (moves ? 2 : 1) * scene.triangles.size() * rows, maxTableBytes);
    tables.attributes.resize(scene.triangles.size() * rows);
    for (size_t t = 0; t < scene.triangles.size(); ++t)
        packAttributes(scene, positions, lights.lightOfTriangle[t], t,
                       std::span(tables.attributes).subspan(t * rows, rows));
    if (tables.features.HAS_INSTANCES) {
        tables.meshes = makeMeshTables(scene, rows, maxTableBytes);
        tables.places = placeInstances(scene, tables.meshes, lengthScale);
    }
    fillSceneData(tables, lights, materials.rows, radius);
    return tables;
}

// All tables together.
void requireRoom(const TableSizes& sizes, uint64_t environmentRows, uint32_t worlds, uint64_t maxTableBytes)
{
    const uint64_t nodes = worlds * (uint64_t{sizes.nodes} + sizes.placeNodes) + sizes.meshNodes;
    requireFits("materials, lights and instances", environmentRows + worlds * uint64_t{sizes.sceneData}, maxTableBytes);
    requireFits(
        "trees", nodes,
        std::min(maxTableBytes, uint64_t{shared::BVH_MAX_NODES} * shared::BVH_NODE_STRIDE * sizeof(glm::uvec4)));
    requireFits("triangles and instances",
                worlds * (uint64_t{sizes.triangles} + sizes.placeRecords) + sizes.meshRecords, maxTableBytes);
    requireFits("triangles", worlds * uint64_t{sizes.attributes} + sizes.meshAttributes, maxTableBytes);
}

} // namespace

BvhStats statsOf(const SceneTables& tables)
{
    BvhStats all = tables.bvh.stats;
    const BvhStats& meshes = tables.meshes.stats;
    all.nodes += meshes.nodes;
    all.triangleRecords += meshes.triangleRecords;
    all.skippedTriangles += meshes.skippedTriangles;
    all.bytes += meshes.bytes;
    all.buildSeconds += meshes.buildSeconds;
    all.depth = std::max(all.depth, meshes.depth);
    return all;
}

TableSizes sizesOf(const SceneTables& tables)
{
    return {.nodes = uint32_t(tables.bvh.nodes.size()),
            .triangles = uint32_t(tables.bvh.triangles.size()),
            .attributes = uint32_t(tables.attributes.size()),
            .sceneData = uint32_t(tables.sceneData.size()),
            .placeNodes = uint32_t(tables.places.nodes.size()),
            .placeRecords = uint32_t(tables.places.records.size()),
            .depth = statsOf(tables).depth,
            .meshNodes = uint32_t(tables.meshes.nodes.size()),
            .meshRecords = uint32_t(tables.meshes.triangles.size()),
            .meshAttributes = uint32_t(tables.meshes.attributes.size())};
}

SceneTables makeSceneTables(const Scene& scene, uint64_t maxTableBytes, const std::function<void(double)>& bvhProgress,
                            FeatureSet featureSet)
{
    const double radius = radiusOf(scene);
    const double lengthScale = powerOfTwoScale(radius);
    const std::vector<glm::vec3> positions = scaled(scene.positions, lengthScale);
    const LightTables lights = makeLightTables(scene, positions, lengthScale, radius * lengthScale);
    SceneTables tables = tablesOf(scene, positions, lengthScale, radius, lights,
                                  makeMaterialTables(scene, lights.radianceScale), false, maxTableBytes, featureSet);
    tables.bvh = buildBvh({.positions = positions,
                           .triangles = scene.triangles,
                           .needsAlphaTest = alphaTests(scene, tables.features),
                           .progress = bvhProgress},
                          maxTableBytes);
    requireRoom(sizesOf(tables), tables.environment.size(), 1, maxTableBytes);
    return tables;
}

struct MovingTables::Kept {
    std::vector<glm::vec3> positions; // scaled, of the last pose
    LightTables lights;               // at rest
    std::vector<glm::uvec4> materials;
    SceneTables tables; // of the last pose
    std::vector<uint8_t> needsAlphaTest;
    std::vector<uint32_t> movingTriangles, movingVertices;
    double stillSquaredRadius = 0; // of the vertices that do not move
    std::vector<Box> meshBoxes;
    bool placesMove = false;
    std::optional<MovingBvh> bvh;
    TableSizes most;
    TableChanges changes;

    BvhInput bvhInput(const Scene& scene) const
    {
        return {.positions = positions, .triangles = scene.triangles, .needsAlphaTest = needsAlphaTest};
    }
    void findWhatMoves(const Scene& scene);
    double radiusOf(const Scene& scene) const;
};

// Those of the parts; all of a scene without animations, of which whoever moves it says nothing.
void MovingTables::Kept::findWhatMoves(const Scene& scene)
{
    std::vector<uint8_t> triangles(scene.triangles.size(), scene.motion->animations.empty());
    for (const Motion::Part& part : scene.motion->parts)
        std::fill_n(triangles.begin() + part.firstTriangle, scene.motion->meshes[part.mesh].triangles.size(), 1);
    std::vector<uint8_t> vertices(scene.positions.size(), scene.motion->animations.empty());
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        if (!triangles[t]) continue;
        movingTriangles.push_back(t);
        for (const uint32_t v : scene.triangles[t].vertices) vertices[v] = 1;
    }
    for (const Motion::Part& part : scene.motion->parts) // also what no triangle names at rest
        std::fill_n(vertices.begin() + part.firstVertex, scene.motion->meshes[part.mesh].vertices.count, 1);
    for (uint32_t v = 0; v < vertices.size(); ++v)
        if (vertices[v]) movingVertices.push_back(v);
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        for (const uint32_t v : scene.triangles[t].vertices) {
            if (triangles[t]) continue;
            const glm::dvec3 p(scene.positions[v]);
            stillSquaredRadius = std::max(stillSquaredRadius, glm::dot(p, p));
        }
    }
}

double MovingTables::Kept::radiusOf(const Scene& scene) const
{
    double squared = std::max(stillSquaredRadius, squaredRadiusOfInstances(scene, meshBoxes));
    for (const uint32_t t : movingTriangles) {
        for (const uint32_t v : scene.triangles[t].vertices) {
            const glm::dvec3 p(scene.positions[v]);
            squared = std::max(squared, glm::dot(p, p));
        }
    }
    return std::sqrt(squared);
}

MovingTables::MovingTables(const Scene& rest, uint64_t maxTableBytes, const std::function<void(double)>& bvhProgress,
                           FeatureSet featureSet)
    : kept_(std::make_unique<Kept>())
{
    CHECK(rest.motion);
    Kept& kept = *kept_;
    kept.findWhatMoves(rest);
    kept.meshBoxes = boxesOf(rest.meshes);
    kept.placesMove = !rest.instances.empty() && (rest.motion->animations.empty() || !rest.motion->instances.empty());
    const double radius = kept.radiusOf(rest), lengthScale = powerOfTwoScale(radius);
    kept.positions = scaled(rest.positions, lengthScale);
    kept.lights = makeLightTables(rest, kept.positions, lengthScale, radius * lengthScale, true);
    MaterialTables materials = makeMaterialTables(rest, kept.lights.radianceScale, true);
    kept.materials = materials.rows;
    kept.tables = tablesOf(rest, kept.positions, lengthScale, radius, kept.lights, std::move(materials), true,
                           maxTableBytes, featureSet);
    kept.lights.environment.clear();
    kept.lights.environmentAliases.clear();
    kept.needsAlphaTest = alphaTests(rest, kept.tables.features);
    std::vector<uint8_t> moves(rest.triangles.size());
    for (const uint32_t t : kept.movingTriangles) moves[t] = 1;
    BvhInput input = kept.bvhInput(rest);
    input.progress = bvhProgress;
    kept.bvh.emplace(input, maxTableBytes / 2, std::move(moves)); // one of two worlds
    kept.tables.bvh = kept.bvh->at(input);

    const MovingBvh::Most& tree = kept.bvh->most();
    const size_t lights = kept.lights.emitters.size() + rest.lights.size() + 1;
    const SceneTables& made = kept.tables;
    kept.most = sizesOf(made);
    kept.most.nodes = tree.nodeRows;
    kept.most.triangles = tree.recordRows;
    kept.most.sceneData =
        uint32_t(kept.materials.size() + kept.lights.punctual.size() + lights + made.places.rows.size());
    kept.most.placeNodes = roomForNodesOver(rest.instances.size());
    kept.most.depth = std::max(tree.depth, made.meshes.stats.depth);
    requireRoom(kept.most, made.environment.size(), 2, maxTableBytes);
    kept.changes.attributes = rangesOf(kept.movingTriangles, kept.tables.uniform.attributeRows);
    kept.changes.tree = kept.bvh->changes();
}

MovingTables::MovingTables(const MovingTables& other) : kept_(std::make_unique<Kept>(*other.kept_)) {}

MovingTables::~MovingTables() = default;

void MovingTables::forgetShared()
{
    kept_->tables.texels = {};
    MeshTables& meshes = kept_->tables.meshes;
    meshes.nodes = meshes.triangles = meshes.attributes = {};
}

const SceneTables& MovingTables::at(const Scene& posed)
{
    Kept& kept = *kept_;
    SceneTables& tables = kept.tables;
    const uint32_t rows = tables.uniform.attributeRows;
    CHECK_EQ(posed.triangles.size() * rows, tables.attributes.size());
    PlaceTables places;
    if (kept.placesMove) places = placeInstances(posed, tables.meshes, tables.lengthScale);
    if (places.nodes.size() > kept.most.placeNodes)
        throw Error("A pose of the scene needs a larger tree over its instances than it has room for.");
    const double radius = kept.radiusOf(posed);
    for (const uint32_t v : kept.movingVertices) kept.positions[v] = scaled(posed.positions[v], tables.lengthScale);
    for (const uint32_t t : kept.movingTriangles)
        packAttributes(posed, kept.positions, kept.lights.lightOfTriangle[t], t,
                       std::span(tables.attributes).subspan(size_t{t} * rows, rows));
    if (kept.placesMove) tables.places = std::move(places);
    const LightTables lights =
        makeLightTables(posed, kept.positions, tables.lengthScale, radius * tables.lengthScale, kept.lights);
    fillSceneData(tables, lights, repaint(kept.materials, posed, tables.radianceScale), radius);
    tables.bvh = kept.bvh->at(kept.bvhInput(posed));
    kept.changes.tree = kept.bvh->changes();
    return tables;
}

const SceneTables& MovingTables::last() const
{
    return kept_->tables;
}

const TableChanges& MovingTables::changes() const
{
    return kept_->changes;
}

const TableSizes& MovingTables::most() const
{
    return kept_->most;
}

} // namespace scene
