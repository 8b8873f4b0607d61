#include "engine/scene/motion_builder.h"

#include <numbers>

#include <fmt/format.h>

namespace scene
{

namespace
{

template <class T>
uint32_t append(std::vector<T>& list, const T& entry)
{
    list.push_back(entry);
    return static_cast<uint32_t>(list.size() - 1);
}

std::vector<double> toNumbers(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

std::vector<double> toNumbers(const glm::dquat& q)
{
    return {q.x, q.y, q.z, q.w};
}

glm::dquat toQuaternion(const std::vector<double>& n)
{
    return {n[3], n[0], n[1], n[2]};
}

std::vector<double> toNumbers(const std::vector<glm::vec3>& vectors)
{
    std::vector<double> numbers;
    for (const glm::vec3& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
}

glm::dvec3 positionOf(const MeshVertices& vertices, size_t v)
{
    const double* p = &vertices.values[POSITION][3 * v];
    return {p[0], p[1], p[2]};
}

} // namespace

MotionBuilder::MotionBuilder(Scene& scene, double period) : scene_(scene)
{
    motion_->animations = {{.name = scene.name, .seconds = period}};
}

uint32_t MotionBuilder::addNode(const Transform& rest, uint32_t parent)
{
    return append(motion_->nodes, {.parent = parent, .rest = rest});
}

uint32_t MotionBuilder::addMesh(const Scene& shape)
{
    Mesh mesh;
    mesh.vertices.count = shape.positions.size();
    mesh.vertices.values[POSITION] = toNumbers(shape.positions);
    mesh.vertices.values[NORMAL] = toNumbers(shape.normals);
    for (const Triangle& triangle : shape.triangles) mesh.triangles.push_back(triangle.vertices);
    return append(motion_->meshes, mesh);
}

void MotionBuilder::addMorphTarget(uint32_t mesh, const std::function<glm::dvec3(const glm::dvec3&)>& displacement)
{
    MeshVertices& vertices = motion_->meshes[mesh].vertices;
    Displacements& moved = vertices.targets.emplace_back()[POSITION];
    for (uint32_t v = 0; v < vertices.count; ++v) {
        const glm::dvec3 added = displacement(positionOf(vertices, v));
        moved.vertices.push_back(v);
        moved.values.insert(moved.values.end(), {added.x, added.y, added.z});
    }
    vertices.values[NORMAL].clear();
}

uint32_t MotionBuilder::storeMesh(const Scene& shape, uint32_t material)
{
    Geometry mesh = shape;
    for (Triangle& triangle : mesh.triangles) triangle.material = material;
    return append(scene_.meshes, mesh);
}

void MotionBuilder::addInstance(uint32_t node, uint32_t storedMesh)
{
    motion_->instances.push_back({.instance = append(scene_.instances, {.mesh = storedMesh}), .node = node});
}

uint32_t MotionBuilder::addPart(uint32_t node, uint32_t mesh, uint32_t material, const glm::dmat4& nodeFromMesh)
{
    const size_t vertices = scene_.positions.size(), triangles = scene_.triangles.size();
    scene_.positions.resize(vertices + motion_->meshes[mesh].vertices.count);
    scene_.normals.resize(scene_.positions.size());
    scene_.triangles.resize(triangles + motion_->meshes[mesh].triangles.size(), {.material = material});
    return append(motion_->parts, {.name = fmt::format("meshes[{}] at nodes[{}]", mesh, node),
                                   .node = node,
                                   .mesh = mesh,
                                   .nodeFromMesh = nodeFromMesh,
                                   .firstVertex = static_cast<uint32_t>(vertices),
                                   .firstTriangle = static_cast<uint32_t>(triangles)});
}

void MotionBuilder::bind(uint32_t index, const std::vector<uint32_t>& joints,
                         const std::function<std::vector<Influence>(const glm::dvec3&)>& influences)
{
    Motion::Part& part = motion_->parts[index];
    Motion::Skin skin{.joints = joints};
    const glm::dmat4 worldFromMesh = worldFromNode(part.node) * part.nodeFromMesh;
    for (const uint32_t joint : joints)
        skin.inverseBindings.push_back(glm::inverse(worldFromNode(joint)) * worldFromMesh);
    part.skin = append(motion_->skins, skin);
    MeshVertices& vertices = motion_->meshes[part.mesh].vertices;
    for (size_t v = 0; v < vertices.count; ++v) {
        for (const Influence& influence : influences(positionOf(vertices, v))) vertices.influences.push_back(influence);
        vertices.influenceEnds.push_back(static_cast<uint32_t>(vertices.influences.size()));
    }
}

void MotionBuilder::addLight(uint32_t node, const PunctualLight& light)
{
    const uint32_t lamp = append(
        motion_->lamps,
        {.color = light.intensity, .innerConeAngle = light.innerConeAngle, .outerConeAngle = light.outerConeAngle});
    motion_->lights.push_back({append(scene_.lights, light), node, lamp});
}

void MotionBuilder::turn(uint32_t node, const glm::dvec3& axis, int turns)
{
    glm::dquat& rest = motion_->nodes[node].rest.rotation;
    const auto quarters = static_cast<uint32_t>(4 * std::abs(turns)); // less than half a turn from key to key
    rest = toQuaternion(addChannel(Property::Rotation, node, quarters, Interpolation::Linear, [&](double phase) {
        return toNumbers(glm::angleAxis(2 * std::numbers::pi * turns * phase, axis) * rest);
    }));
}

void MotionBuilder::translate(uint32_t node, uint32_t steps, const At<glm::dvec3>& translation)
{
    const Numbers first = addChannel(Property::Translation, node, steps, Interpolation::CubicSpline,
                                     [&](double phase) { return toNumbers(translation(phase)); });
    motion_->nodes[node].rest.translation = {first[0], first[1], first[2]};
}

void MotionBuilder::rotate(uint32_t node, uint32_t steps, const At<glm::dquat>& rotation)
{
    motion_->nodes[node].rest.rotation =
        toQuaternion(addChannel(Property::Rotation, node, steps, Interpolation::CubicSpline,
                                [&](double phase) { return toNumbers(rotation(phase)); }));
}

void MotionBuilder::morph(uint32_t node, uint32_t steps, const At<Numbers>& weights)
{
    motion_->nodes[node].weights = addChannel(Property::Weights, node, steps, Interpolation::CubicSpline, weights);
}

void MotionBuilder::finish()
{
    scene_.motion = motion_;
    pose(scene_, {}, 0);
}

MotionBuilder::Numbers MotionBuilder::addChannel(Property property, uint32_t node, uint32_t steps,
                                                 Interpolation interpolation, const At<Numbers>& value)
{
    constexpr double STEP = 1e-4; // of the phase, for slopes
    Animation& animation = motion_->animations[0];
    const bool cubic = interpolation == Interpolation::CubicSpline;
    std::vector<float> times, values;
    Numbers first = value(0);
    for (uint32_t key = 0; key <= steps; ++key) {
        const double phase = double(key) / steps;
        times.push_back(static_cast<float>(animation.seconds * phase));
        const Numbers before = value(phase - STEP), now = value(phase), after = value(phase + STEP);
        Numbers slope;
        for (size_t i = 0; cubic && i < now.size(); ++i)
            slope.push_back((after[i] - before[i]) / (2 * STEP * animation.seconds));
        for (const Numbers& numbers : {slope, now, slope}) values.insert(values.end(), numbers.begin(), numbers.end());
    }
    interpolate(interpolation, property == Property::Rotation, times, values, 0, first); // rounded as the keys are
    animation.channels.push_back({.property = property,
                                  .object = node,
                                  .interpolation = interpolation,
                                  .width = static_cast<uint32_t>(first.size()),
                                  .times = append(motion_->numbers, times),
                                  .values = append(motion_->numbers, values)});
    return first;
}

glm::dmat4 MotionBuilder::worldFromNode(uint32_t node) const
{
    const Motion::Node& found = motion_->nodes[node];
    const glm::dmat4 local = found.rest.toMatrix();
    return found.parent == NONE ? local : worldFromNode(found.parent) * local;
}

} // namespace scene
