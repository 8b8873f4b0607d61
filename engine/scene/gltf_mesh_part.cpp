#include "engine/scene/gltf_mesh_part.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_materials.h"

namespace scene::gltf
{

namespace
{

constexpr std::array<const char*, ATTRIBUTES> NAMES = {"POSITION",   "NORMAL",     "TANGENT",
                                                       "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
constexpr uint64_t MAX_DISPLACEMENTS = uint64_t{1} << 24; // of all morph targets that are kept: 1.4 GB

template <class Attributes>
int find(const Attributes& attributes, const std::string& name)
{
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

// Components that a primitive's attribute has, as far as they count; morph targets add nothing to a tangent's side.
uint32_t widthOf(Attribute attribute, const Accessor& base, const Accessor* target = nullptr)
{
    const uint32_t width = std::min(ATTRIBUTE_WIDTH[attribute], base.components());
    if (!target) return width;
    return std::min({width, target->components(), attribute == TANGENT ? 3 : width});
}

} // namespace

struct MeshPartReader::Source {
    std::string where;
    std::array<const Accessor*, ATTRIBUTES> base = {};
    std::vector<std::array<const Accessor*, ATTRIBUTES>> targets;
    std::vector<std::array<const Accessor*, 2>> skin; // joints and weights of each set
    size_t jointCount = 0;                            // 0: not skinned
    bool hasTangents = false;
};

const Accessor& MeshPartReader::accessor(int index)
{
    const auto known = accessors_.find(index);
    return known != accessors_.end() ? known->second : accessors_.try_emplace(index, document_, index).first->second;
}

MeshPartReader::Source MeshPartReader::open(const tinygltf::Primitive& primitive, const std::string& where,
                                            size_t jointCount, const Material& material)
{
    Source source{.where = where, .jointCount = jointCount, .hasTangents = material.normalTexture.image != NONE};
    std::array<bool, 2> wantsUv = {};
    eachTexture(material, [&](const TextureUse& use) { wantsUv[use.uvSet] = true; });
    source.targets.resize(primitive.targets.size());
    for (uint32_t a = 0; a < ATTRIBUTES; ++a) {
        const int base = find(primitive.attributes, NAMES[a]);
        if (base < 0 || (a == TEXCOORD_0 && !wantsUv[0]) || (a == TEXCOORD_1 && !wantsUv[1])) continue;
        if (a == TANGENT && !(source.base[NORMAL] && source.hasTangents)) continue;
        source.base[a] = &accessor(base);
        for (size_t t = 0; t < source.targets.size(); ++t) {
            const int target = find(primitive.targets[t], NAMES[a]);
            if (target >= 0) source.targets[t][a] = &accessor(target);
        }
    }
    for (int set = 0; jointCount > 0 && set < 4; ++set) {
        const int joints = find(primitive.attributes, "JOINTS_" + std::to_string(set));
        const int weights = find(primitive.attributes, "WEIGHTS_" + std::to_string(set));
        if (joints < 0 || weights < 0) break;
        source.skin.push_back({&accessor(joints), &accessor(weights)});
    }
    return source;
}

// The triangles of a list, strip or fan (glTF 2.0, 3.7.2.1), as elements of the attributes.
std::vector<std::array<uint32_t, 3>> MeshPartReader::readTriangles(const tinygltf::Primitive& primitive,
                                                                   size_t vertexCount, const std::string& where)
{
    const Accessor* indices = primitive.indices >= 0 ? &accessor(primitive.indices) : nullptr;
    const size_t count = indices ? indices->count() : vertexCount;
    const auto element = [&](size_t i) {
        const uint32_t value = indices ? indices->integer(i, 0) : static_cast<uint32_t>(i);
        if (value >= vertexCount)
            throw Error("{} has the index {} at {}, but {} vertices.", where, value, i, vertexCount);
        return value;
    };

    std::vector<std::array<uint32_t, 3>> triangles;
    const auto add = [&](size_t a, size_t b, size_t c) {
        const std::array<uint32_t, 3> triangle = {element(a), element(b), element(c)};
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
            triangles.push_back(triangle);
    };
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(count / 3);
        for (size_t i = 0; i + 2 < count; i += 3) add(i, i + 1, i + 2);
        if (count % 3 != 0)
            warnings_.add(fmt::format("Ignored the last {} of {} indices of {}.", count % 3, count, where));
    } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (size_t i = 0; i + 2 < count; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
    } else {
        for (size_t i = 1; i + 1 < count; ++i) add(i, i + 1, 0);
    }
    return triangles;
}

// What the triangles refer to, in the order of its first use; the triangles then count these. Each corner has its own
// where the normals are to be flat.
std::vector<uint32_t> MeshPartReader::usedElements(std::vector<std::array<uint32_t, 3>>& triangles, size_t elementCount,
                                                   bool flat)
{
    std::vector<uint32_t> elements;
    if (vertexOf_.size() < elementCount) {
        vertexOf_.resize(elementCount);
        stampOf_.resize(elementCount, 0);
    }
    ++stamp_;
    for (auto& triangle : triangles) {
        for (uint32_t& corner : triangle) {
            const uint32_t element = corner;
            if (!flat && stampOf_[element] == stamp_) {
                corner = vertexOf_[element];
                continue;
            }
            stampOf_[element] = stamp_;
            vertexOf_[element] = corner = static_cast<uint32_t>(elements.size());
            elements.push_back(element);
        }
    }
    return elements;
}

// glTF 2.0, 3.7.3.3: up to four joints a set. Vertices whose weights are all zero stay where their mesh stands.
void MeshPartReader::gatherInfluences(const Source& source, std::span<const uint32_t> elements, MeshVertices& vertices)
{
    for (const uint32_t element : elements) {
        const size_t before = vertices.influences.size();
        double total = 0;
        for (const auto& [joints, weights] : source.skin) {
            for (uint32_t c = 0; c < 4; ++c) {
                const double weight = weights->number(element, c);
                if (weight == 0) continue;
                const uint32_t joint = joints->integer(element, c);
                if (joint >= source.jointCount)
                    throw Error("{} uses joint {} at vertex {}, but its skin has {}.", source.where, joint, element,
                                source.jointCount);
                vertices.influences.push_back({joint, weight});
                total += weight;
            }
        }
        if (total == 0) { // NaN goes on: its triangles are dropped
            vertices.influences.resize(before);
            warnings_.add(fmt::format("Left vertices of {} unskinned: their weights are all zero.", source.where));
        }
        vertices.influenceEnds.push_back(static_cast<uint32_t>(vertices.influences.size()));
    }
}

// Morph targets are read where their weight is not zero.
MeshVertices MeshPartReader::gather(const Source& source, std::span<const uint32_t> elements,
                                    std::span<const double> weights)
{
    MeshVertices vertices{.count = elements.size()};
    vertices.targets.resize(source.targets.size());
    for (uint32_t a = 0; a < ATTRIBUTES; ++a) {
        const Accessor* base = source.base[a];
        if (!base) continue;
        const uint32_t full = ATTRIBUTE_WIDTH[a], width = widthOf(Attribute(a), *base);
        std::vector<double>& values = vertices.values[a];
        values.assign(elements.size() * full, a == COLOR_0 ? 1 : 0);
        for (size_t v = 0; v < elements.size(); ++v) {
            for (uint32_t c = 0; c < width; ++c) values[v * full + c] = base->number(elements[v], c);
        }
        for (size_t t = 0; t < std::min(weights.size(), source.targets.size()); ++t) {
            const Accessor* target = source.targets[t][a];
            if (weights[t] == 0 || !target) continue;
            Displacements& moved = vertices.targets[t][a];
            const uint32_t moves = widthOf(Attribute(a), *base, target);
            for (size_t v = 0; v < elements.size(); ++v) {
                std::array<double, 4> value = {};
                for (uint32_t c = 0; c < moves; ++c) value[c] = target->number(elements[v], c);
                if (value == std::array<double, 4>{}) continue;
                moved.vertices.push_back(static_cast<uint32_t>(v));
                moved.values.insert(moved.values.end(), value.begin(), value.begin() + full);
            }
        }
    }
    if (source.jointCount > 0) gatherInfluences(source, elements, vertices);
    return vertices;
}

// Of a part where it stands at rest.
void MeshPartReader::warn(const MeshPart& part, const std::string& where, const Material& material)
{
    const auto& [uvs, colors, normals] = part.replaced;
    if (uvs > 0) warnings_.add("Took 0 for a texture coordinate that is not finite or beyond 1e6.", uvs);
    if (colors > 0) warnings_.add("Clamped a vertex color to the range from 0 to 1.", colors);
    bool wantsUv = false;
    eachTexture(material, [&](const TextureUse&) { wantsUv = true; });
    if (wantsUv && !part.hasUv[0] && !part.hasUv[1])
        warnings_.add(fmt::format("{} has a texture but no texture coordinates for it.", where));
    const auto dropped = std::ranges::count_if(part.triangles, [&](const auto& t) { return !isFinite(part, t); });
    if (dropped > 0)
        warnings_.add("Dropped a triangle with a vertex that is not finite.", static_cast<size_t>(dropped));
    if (normals > 0) warnings_.add("Replaced a normal that has no direction by that of the triangles.", normals);
}

MeshPart MeshPartReader::read(const tinygltf::Primitive& primitive, const std::string& where,
                              const Placement& placement, const Material& material)
{
    const Source source = open(primitive, where, placement.worldFromSkin.size(), material);
    MeshPart part{.hasUv = {source.base[TEXCOORD_0] != nullptr, source.base[TEXCOORD_1] != nullptr},
                  .hasTangents = source.hasTangents,
                  .hasColors = source.base[COLOR_0] != nullptr};
    part.triangles = readTriangles(primitive, source.base[POSITION]->count(), where);
    const std::vector<uint32_t> elements =
        usedElements(part.triangles, source.base[POSITION]->count(), !source.base[NORMAL]);

    // Through a block that stays in the cache: the primitive itself is never in memory twice.
    constexpr size_t BLOCK = 1024;
    part.vertices.resize(elements.size());
    for (size_t i = 0; i < elements.size(); i += BLOCK) {
        const size_t count = std::min(BLOCK, elements.size() - i);
        const MeshVertices block = gather(source, std::span(elements).subspan(i, count), placement.morphWeights);
        poseVertices(block, placement, std::span(part.vertices).subspan(i, count), part.replaced);
    }
    warn(part, where, material);
    std::erase_if(part.triangles, [&](const auto& triangle) { return !isFinite(part, triangle); });
    turnMirrored(part);
    completeNormals(part);
    if (part.hasTangents) completeTangents(part, material.normalTexture, true);
    return part;
}

Mesh MeshPartReader::readMesh(const tinygltf::Primitive& primitive, const std::string& where, size_t jointCount,
                              const Material& material)
{
    const Source source = open(primitive, where, jointCount, material);
    Mesh mesh{.hasTangents = source.hasTangents};
    mesh.triangles = readTriangles(primitive, source.base[POSITION]->count(), where);
    const std::vector<uint32_t> elements =
        usedElements(mesh.triangles, source.base[POSITION]->count(), !source.base[NORMAL]);
    displacements_ += elements.size() * source.targets.size();
    if (displacements_ > MAX_DISPLACEMENTS)
        throw Error(
            "The morph targets up to {}, which has {} for {} vertices, hold {} displacements, more than the limit "
            "of {}: use fewer, or leave animations out.",
            where, source.targets.size(), elements.size(), displacements_, MAX_DISPLACEMENTS);
    mesh.vertices = gather(source, elements, std::vector<double>(source.targets.size(), 1));

    // What is not finite in the file is so in every pose.
    std::vector<bool> bad(elements.size(), false);
    const auto note = [&](size_t v, std::span<const double> numbers) {
        if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); })) bad[v] = true;
    };
    for (size_t v = 0; v < elements.size(); ++v) note(v, std::span(mesh.vertices.values[POSITION]).subspan(3 * v, 3));
    for (const MorphTarget& target : mesh.vertices.targets) {
        const Displacements& moved = target[POSITION];
        for (size_t i = 0; i < moved.vertices.size(); ++i)
            note(moved.vertices[i], std::span(moved.values).subspan(3 * i, 3));
    }
    for (size_t v = 0, i = 0; v < mesh.vertices.influenceEnds.size(); ++v) {
        for (; i < mesh.vertices.influenceEnds[v]; ++i) note(v, {&mesh.vertices.influences[i].weight, 1});
    }
    const size_t dropped = std::erase_if(mesh.triangles, [&](const auto& triangle) {
        return std::ranges::any_of(triangle, [&](uint32_t v) { return bad[v]; });
    });
    if (dropped > 0) warnings_.add("Dropped a triangle with a vertex that is not finite.", dropped);
    splitSeams(mesh, material.normalTexture);
    return mesh;
}

MeshPart MeshPartReader::place(const Mesh& mesh, const std::string& where, const Placement& placement,
                               const Material& material)
{
    MeshPart part = poseMesh(mesh, placement, material.normalTexture);
    warn(part, where, material);
    return part;
}

} // namespace scene::gltf
