#include "engine/scene/motion.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/fingerprint.h"
#include "engine/scene/choice.h"

namespace scene
{

namespace
{

// All that animations change.
struct State {
    explicit State(const Motion& motion)
        : nodes(motion.nodes), lamps(motion.lamps), lenses(motion.lenses), paints(motion.paints)
    {
    }
    std::vector<Motion::Node> nodes;
    std::vector<Lamp> lamps;
    std::vector<Motion::Lens> lenses;
    std::vector<Motion::Paint> paints;
};

void set(State& state, Property property, uint32_t object, std::span<const double> value)
{
    const auto vec3 = [&] { return glm::dvec3(value[0], value[1], value[2]); };
    switch (property) {
    case Property::Translation: state.nodes[object].rest.translation = vec3(); break;
    case Property::Rotation:
        state.nodes[object].rest.rotation = glm::dquat(value[3], value[0], value[1], value[2]);
        break;
    case Property::Scale: state.nodes[object].rest.scale = vec3(); break;
    case Property::Weights: state.nodes[object].weights.assign(value.begin(), value.end()); break;
    case Property::Visible: state.nodes[object].visible = value[0] != 0; break;
    case Property::LightColor: state.lamps[object].color = vec3(); break;
    case Property::LightIntensity: state.lamps[object].intensity = value[0]; break;
    case Property::InnerCone: state.lamps[object].innerConeAngle = value[0]; break;
    case Property::OuterCone: state.lamps[object].outerConeAngle = value[0]; break;
    case Property::Yfov: state.lenses[object].yfov = value[0]; break;
    case Property::Xmag: state.lenses[object].xmag = value[0]; break;
    case Property::Ymag: state.lenses[object].ymag = value[0]; break;
    case Property::BaseColor: state.paints[object].baseColor = glm::dvec4(vec3(), value[3]); break;
    case Property::Metallic: state.paints[object].metallic = value[0]; break;
    case Property::Roughness: state.paints[object].roughness = value[0]; break;
    case Property::EmissiveFactor: state.paints[object].emissiveFactor = vec3(); break;
    case Property::EmissiveStrength: state.paints[object].emissiveStrength = value[0]; break;
    }
}

// The first animation has the last word.
void play(const Motion& motion, std::span<const uint32_t> animations, double seconds, State& state)
{
    std::vector<double> value;
    for (size_t i = animations.size(); i-- > 0;) {
        CHECK_LT(animations[i], motion.animations.size());
        for (const Channel& channel : motion.animations[animations[i]].channels) {
            value.resize(channel.width);
            interpolate(channel.interpolation, channel.property == Property::Rotation, motion.numbers[channel.times],
                        motion.numbers[channel.values], seconds, value);
            set(state, channel.property, channel.object, value);
        }
    }
}

struct World {
    std::vector<glm::dmat4> worldFromNode;
    std::vector<bool> visible;
    std::vector<std::vector<glm::dmat4>> worldFromSkin; // by skin, by joint
};

World worldOf(const Motion& motion, const State& state)
{
    World world;
    for (const Motion::Node& node : state.nodes) {
        const bool top = node.parent == NONE;
        world.worldFromNode.push_back((top ? node.worldFromParent : world.worldFromNode[node.parent]) *
                                      node.rest.toMatrix());
        world.visible.push_back(node.visible && (top || world.visible[node.parent]));
    }
    for (const Motion::Skin& skin : motion.skins) {
        auto& matrices = world.worldFromSkin.emplace_back();
        for (size_t i = 0; i < skin.joints.size(); ++i)
            matrices.push_back(world.worldFromNode[skin.joints[i]] * skin.inverseBindings[i]);
    }
    return world;
}

template <class T, class Get>
void write(std::vector<T>& array, uint32_t first, const MeshPart& part, bool has, Get&& get)
{
    for (size_t v = 0; has && v < part.vertices.size(); ++v) array[first + v] = T(get(part.vertices[v]));
}

// Without area, so that nothing meets it.
void hidePart(Scene& scene, const Motion::Part& part, const Mesh& mesh)
{
    const auto fill = [&](auto& array, const auto& value) {
        if (!array.empty()) std::fill_n(array.begin() + part.firstVertex, mesh.vertices.count, value);
    };
    fill(scene.positions, glm::vec3(0));
    fill(scene.normals, glm::vec3(0, 0, 1));
    fill(scene.tangents, glm::vec4(1, 0, 0, 1));
    fill(scene.uv0, glm::vec2(0));
    fill(scene.uv1, glm::vec2(0));
    fill(scene.colors, glm::vec4(1));
    for (size_t t = part.firstTriangle; t < part.firstTriangle + mesh.triangles.size(); ++t)
        scene.triangles[t].vertices.fill(part.firstVertex);
}

constexpr double FARTHEST = LARGEST_SCENE / 2;

bool isNear(const glm::dvec3& position) // also not where one is NaN
{
    return glm::all(glm::lessThanEqual(glm::abs(position), glm::dvec3(FARTHEST)));
}

Error tooFar(double seconds, const std::string& what)
{
    return Error("At {} s, {} is more than {} m from the middle of the scene or not finite: choose another time or "
                 "animation.",
                 seconds, what, FARTHEST);
}

void writePart(Scene& scene, const Motion::Part& part, const MeshPart& posed, bool atRest, double seconds)
{
    std::vector<bool> lost(posed.vertices.size(), false);
    for (size_t v = 0; v < posed.vertices.size(); ++v) {
        const glm::dvec3 position = posed.vertices[v].position - scene.origin;
        lost[v] = !isNear(position);
        scene.positions[part.firstVertex + v] = lost[v] ? glm::vec3(0) : glm::vec3(position);
    }
    for (size_t t = 0; t < posed.triangles.size(); ++t) {
        auto& vertices = scene.triangles[part.firstTriangle + t].vertices;
        if (atRest && !isFinite(posed, posed.triangles[t])) { // the loader has said so
            vertices.fill(part.firstVertex + posed.triangles[t][0]);
            continue;
        }
        std::array<glm::dvec3, 3> corners;
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t v = posed.triangles[t][i];
            if (lost[v]) throw tooFar(seconds, fmt::format("vertex {} of {}", v, part.name));
            vertices[i] = part.firstVertex + v;
            corners[i] = scene.positions[vertices[i]];
        }
        const double area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        if (!(area >= SMALLEST_AREA)) vertices.fill(vertices[0]);
    }
    write(scene.normals, part.firstVertex, posed, true, [](const Vertex& v) { return v.normal; });
    write(scene.tangents, part.firstVertex, posed, posed.hasTangents, [](const Vertex& v) { return v.tangent; });
    write(scene.uv0, part.firstVertex, posed, posed.hasUv[0], [](const Vertex& v) { return v.uv[0]; });
    write(scene.uv1, part.firstVertex, posed, posed.hasUv[1], [](const Vertex& v) { return v.uv[1]; });
    write(scene.colors, part.firstVertex, posed, posed.hasColors, [](const Vertex& v) { return v.color; });
}

void placeInstances(Scene& scene, const Motion& motion, const World& world, double seconds)
{
    for (const Motion::PlacedInstance& placed : motion.instances) {
        Instance& instance = scene.instances[placed.instance];
        instance.visible = world.visible[placed.node];
        instance.worldFromMesh = world.worldFromNode[placed.node] * placed.nodeFromMesh;
        instance.worldFromMesh[3] -= glm::dvec4(scene.origin, 0);
        // Its coordinates are at most about 1 in its own space.
        glm::dvec3 farthest(0);
        for (int i = 0; i < 4; ++i) farthest += glm::abs(glm::dvec3(instance.worldFromMesh[i]));
        if (!isNear(farthest)) throw tooFar(seconds, fmt::format("instance {}", placed.instance));
    }
}

void placeLights(Scene& scene, const Motion& motion, const State& state, const World& world)
{
    const Clamp clamp = [](double value, double low, double high, const char*) { return std::clamp(value, low, high); };
    for (const Motion::PlacedLight& placed : motion.lights) {
        PunctualLight& light = scene.lights[placed.light];
        shine(light, state.lamps[placed.lamp], clamp);
        if (placed.node == NONE) continue;
        const auto position = placeLight(light, world.worldFromNode[placed.node]);
        light.position = position ? glm::vec3(*position - scene.origin) : glm::vec3(0);
        if (!position) light.direction = {0, 0, -1};
        if (!position || !world.visible[placed.node]) light.intensity = {0, 0, 0};
    }
}

void placeCameras(Scene& scene, const Motion& motion, const State& state, const World& world)
{
    constexpr double SMALLEST = 1e-12, LARGEST_FOV = std::numbers::pi - 1e-3;
    for (const Motion::PlacedCamera& placed : motion.cameras) {
        Camera& camera = scene.cameras[placed.camera];
        camera = placed.rest;
        const Motion::Lens& lens = state.lenses[placed.lens];
        camera.yfov = std::clamp(lens.yfov, SMALLEST, LARGEST_FOV);
        camera.xmag = std::max(lens.xmag, SMALLEST);
        camera.ymag = std::max(lens.ymag, SMALLEST);
        if (placed.node == NONE || !placeCamera(camera, world.worldFromNode[placed.node])) continue;
        camera.position -= scene.origin;
        aim(camera, motion.radius);
    }
}

void paint(Scene& scene, const State& state)
{
    for (const Motion::Paint& paint : state.paints) {
        Material& material = scene.materials[paint.material];
        material.baseColor = glm::clamp(paint.baseColor, 0.0, 1.0);
        material.metallic = static_cast<float>(std::clamp(paint.metallic, 0.0, 1.0));
        material.roughness = static_cast<float>(std::clamp(paint.roughness, 0.0, 1.0));
        material.emission = glm::clamp(paint.emissiveFactor * paint.emissiveStrength, 0.0, MAX_RADIANCE);
    }
}

} // namespace

uint64_t Motion::bytes() const
{
    const auto size = [](const auto& array) { return uint64_t{array.size() * sizeof(array[0])}; };
    uint64_t sum = size(nodes) + size(parts) + size(instances);
    for (const auto& array : numbers) sum += size(array);
    for (const Mesh& mesh : meshes) {
        sum += size(mesh.triangles) + size(mesh.vertices.influenceEnds) + size(mesh.vertices.influences);
        for (const auto& values : mesh.vertices.values) sum += size(values);
        for (const MorphTarget& target : mesh.vertices.targets) {
            for (const Displacements& moved : target) sum += size(moved.vertices) + size(moved.values);
        }
    }
    return sum;
}

uint64_t Motion::fingerprint() const
{
    uint64_t state = 0;
    const auto take = [&](const auto& values) { state = ::fingerprint(std::as_bytes(std::span(values)), state); };
    const auto takeWords = [&](std::initializer_list<uint64_t> list) { take(std::vector(list)); };
    const auto takeDoubles = [&](std::initializer_list<double> list) { take(std::vector(list)); };
    const auto takeMatrix = [&](const glm::dmat4& m) { take(std::vector{m[0], m[1], m[2], m[3]}); };
    for (const Animation& animation : animations) {
        takeWords({animation.channels.size()});
        for (const Channel& c : animation.channels)
            takeWords({uint64_t(c.property), c.object, uint64_t(c.interpolation), c.width, c.times, c.values});
    }
    for (const auto& array : numbers) take(array);
    for (const Node& node : nodes) {
        takeWords({node.parent, node.visible});
        takeMatrix(node.worldFromParent);
        takeMatrix(node.rest.toMatrix());
        take(node.weights);
    }
    for (const Skin& skin : skins) {
        take(skin.joints);
        for (const glm::dmat4& matrix : skin.inverseBindings) takeMatrix(matrix);
    }
    for (const Mesh& mesh : meshes) {
        for (const auto& triangle : mesh.triangles) take(triangle);
        for (const auto& values : mesh.vertices.values) take(values);
        for (const MorphTarget& target : mesh.vertices.targets) {
            for (const Displacements& moved : target) {
                take(moved.vertices);
                take(moved.values);
            }
        }
        take(mesh.vertices.influenceEnds);
        for (const Influence& influence : mesh.vertices.influences)
            takeDoubles({double(influence.joint), influence.weight});
    }
    for (const Part& part : parts) {
        takeWords({part.node, part.mesh, part.skin, part.firstVertex, part.firstTriangle});
        takeMatrix(part.nodeFromMesh);
    }
    for (const PlacedInstance& placed : instances) {
        takeWords({placed.instance, placed.node});
        takeMatrix(placed.nodeFromMesh);
    }
    for (const Lamp& lamp : lamps)
        takeDoubles(
            {lamp.color.x, lamp.color.y, lamp.color.z, lamp.intensity, lamp.innerConeAngle, lamp.outerConeAngle});
    for (const PlacedLight& light : lights) takeWords({light.light, light.node, light.lamp});
    for (const Lens& lens : lenses) takeDoubles({lens.yfov, lens.xmag, lens.ymag});
    for (const PlacedCamera& camera : cameras) takeWords({camera.camera, camera.node, camera.lens});
    for (const Paint& paint : paints)
        takeDoubles({double(paint.material), paint.baseColor.x, paint.baseColor.y, paint.baseColor.z, paint.baseColor.w,
                     paint.metallic, paint.roughness, paint.emissiveFactor.x, paint.emissiveFactor.y,
                     paint.emissiveFactor.z, paint.emissiveStrength});
    return state;
}

std::vector<uint32_t> chooseAnimations(const Scene& scene, const std::string& choice)
{
    if (choice == "off") return {};
    const std::vector<Animation> none;
    const std::vector<Animation>& animations = scene.motion ? scene.motion->animations : none;
    std::vector<uint32_t> chosen(animations.size());
    std::iota(chosen.begin(), chosen.end(), 0u);
    if (choice != "all") {
        std::vector<std::string> names;
        for (const Animation& animation : animations) names.push_back(animation.name);
        chosen = {chooseName(names, choice, "animation")};
    }
    for (const uint32_t i : chosen)
        if (!animations[i].fault.empty())
            throw Error("Animation {} \"{}\" cannot be played: {}", i, animations[i].name, animations[i].fault);
    return chosen;
}

bool contested(const Motion& motion, std::span<const uint32_t> animations)
{
    std::set<std::pair<Property, uint32_t>> moved;
    for (const uint32_t i : animations) {
        for (const Channel& channel : motion.animations[i].channels)
            if (!moved.emplace(channel.property, channel.object).second) return true;
    }
    return false;
}

void pose(Scene& scene, std::span<const uint32_t> animations, double seconds)
{
    if (!scene.motion) return;
    const Motion& motion = *scene.motion;
    State state(motion);
    play(motion, animations, seconds, state);
    const World world = worldOf(motion, state);

    for (const Motion::Part& part : motion.parts) {
        const Mesh& mesh = motion.meshes[part.mesh];
        if (mesh.triangles.empty()) continue;
        if (!world.visible[part.node]) {
            hidePart(scene, part, mesh);
            continue;
        }
        Placement placement{.worldFromMesh = world.worldFromNode[part.node] * part.nodeFromMesh,
                            .morphWeights = state.nodes[part.node].weights};
        if (part.skin != NONE) placement.worldFromSkin = world.worldFromSkin[part.skin];
        const TextureUse& normalTexture = scene.materials[scene.triangles[part.firstTriangle].material].normalTexture;
        writePart(scene, part, poseMesh(mesh, placement, normalTexture), animations.empty(), seconds);
    }
    placeInstances(scene, motion, world, seconds);
    placeLights(scene, motion, state, world);
    placeCameras(scene, motion, state, world);
    paint(scene, state);
}

} // namespace scene
