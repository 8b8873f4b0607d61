#include "engine/scene/gltf_mesh_part.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_materials.h"
#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// cof(M) (a x b) = (M a) x (M b): what normals and areas transform by. Exists for singular matrices too.
glm::dmat3 cofactor(const glm::dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

int find(const tinygltf::Primitive& primitive, const std::string& name)
{
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

} // namespace

struct MeshPartReader::Attribute {
    const Accessor* base = nullptr;
    std::vector<std::pair<double, const Accessor*>> targets;

    double number(uint32_t element, uint32_t component) const
    {
        double sum = base->number(element, component);
        for (const auto& [weight, target] : targets) {
            if (component < target->components()) sum += weight * target->number(element, component);
        }
        return sum;
    }
    glm::dvec3 vec3(uint32_t element) const { return {number(element, 0), number(element, 1), number(element, 2)}; }
};

const Accessor& MeshPartReader::accessor(int index)
{
    const auto known = accessors_.find(index);
    return known != accessors_.end() ? known->second : accessors_.try_emplace(index, document_, index).first->second;
}

MeshPartReader::Attribute MeshPartReader::attribute(const tinygltf::Primitive& primitive, const std::string& name,
                                                    const std::vector<double>* weights)
{
    Attribute result;
    const int base = find(primitive, name);
    if (base < 0) return result;
    result.base = &accessor(base);
    for (size_t i = 0; weights && i < std::min(weights->size(), primitive.targets.size()); ++i) {
        const auto target = primitive.targets[i].find(name);
        if (target != primitive.targets[i].end() && (*weights)[i] != 0)
            result.targets.emplace_back((*weights)[i], &accessor(target->second));
    }
    return result;
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

glm::dmat4 MeshPartReader::skinTransform(const tinygltf::Primitive& primitive, uint32_t element,
                                         const std::string& where, const Placement& placement)
{
    glm::dmat4 sum(0);
    double total = 0;
    for (int set = 0; set < 4; ++set) {
        const std::string suffix = std::to_string(set);
        const int joints = find(primitive, "JOINTS_" + suffix), weights = find(primitive, "WEIGHTS_" + suffix);
        if (joints < 0 || weights < 0) break;
        for (uint32_t c = 0; c < 4; ++c) {
            const double weight = accessor(weights).number(element, c);
            if (weight == 0) continue;
            const uint32_t joint = accessor(joints).integer(element, c);
            if (joint >= placement.worldFromSkin.size())
                throw Error("{} uses joint {} at vertex {}, but its skin has {}.", where, joint, element,
                            placement.worldFromSkin.size());
            sum += weight * placement.worldFromSkin[joint];
            total += weight;
        }
    }
    if (total == 0) { // NaN goes on: its triangles are dropped
        warnings_.add(fmt::format("Left vertices of {} unskinned: their weights are all zero.", where));
        return placement.worldFromMesh;
    }
    return sum / total;
}

void MeshPartReader::readVertices(const tinygltf::Primitive& primitive, const std::string& where,
                                  const Placement& placement, const std::vector<uint32_t>& elements, MeshPart& part)
{
    const auto open = [&](const char* name) { return attribute(primitive, name, placement.morphWeights); };
    const Attribute position = open("POSITION"), normal = open("NORMAL"), tangent = open("TANGENT"),
                    color = open("COLOR_0");
    const std::array<Attribute, 2> uv = {open("TEXCOORD_0"), open("TEXCOORD_1")};
    for (size_t set = 0; set < 2; ++set) part.hasUv[set] = part.hasUv[set] && uv[set].base;
    part.hasColors = color.base != nullptr;

    glm::dmat4 world = placement.worldFromMesh;
    size_t badUvs = 0, badColors = 0;
    part.vertices.resize(elements.size());
    for (size_t i = 0; i < elements.size(); ++i) {
        const uint32_t element = elements[i];
        Vertex& vertex = part.vertices[i];
        if (!placement.worldFromSkin.empty()) world = skinTransform(primitive, element, where, placement);
        const glm::dmat3 linear(world);
        const double side = glm::determinant(linear) < 0 ? -1 : 1;
        vertex.mirrored = side < 0;
        vertex.position = glm::dvec3(world * glm::dvec4(position.vec3(element), 1));
        if (normal.base) vertex.normal = unitOrZero(side * (cofactor(linear) * normal.vec3(element)));
        if (normal.base && tangent.base && part.hasTangents) {
            const double handedness = tangent.base->components() > 3 ? tangent.base->number(element, 3) : 0;
            const glm::dvec3 direction = unitOrZero(linear * tangent.vec3(element));
            if (handedness != 0 && direction != glm::dvec3(0))
                vertex.tangent = {direction, handedness < 0 ? -side : side};
        }
        for (size_t set = 0; set < 2; ++set) {
            if (!part.hasUv[set]) continue;
            constexpr double LARGEST = 1e6; // where float32 has lost the texel anyway
            const glm::dvec2 value(uv[set].number(element, 0), uv[set].number(element, 1));
            if (std::abs(value.x) < LARGEST && std::abs(value.y) < LARGEST)
                vertex.uv[set] = value;
            else
                ++badUvs;
        }
        for (uint32_t c = 0; part.hasColors && c < color.base->components(); ++c) {
            const double value = color.number(element, c);
            vertex.color[static_cast<int>(c)] =
                static_cast<float>(std::clamp(std::isnan(value) ? 1.0 : value, 0.0, 1.0));
            if (!(value >= 0 && value <= 1)) ++badColors;
        }
    }
    if (badUvs > 0) warnings_.add("Took 0 for a texture coordinate that is not finite or beyond 1e6.", badUvs);
    if (badColors > 0) warnings_.add("Clamped a vertex color to the range from 0 to 1.", badColors);
}

MeshPart MeshPartReader::read(const tinygltf::Primitive& primitive, const std::string& where,
                              const Placement& placement, const Material& material)
{
    const bool flat = find(primitive, "NORMAL") < 0;
    const size_t elementCount = accessor(find(primitive, "POSITION")).count();
    MeshPart part;
    part.triangles = readTriangles(primitive, elementCount, where);
    part.hasTangents = material.normalTexture.image != NONE;
    eachTexture(material, [&](const TextureUse& use) { part.hasUv[use.uvSet] = true; });

    // Only vertices that a triangle uses; each corner its own where the normals are to be flat.
    std::vector<uint32_t> elements;
    if (vertexOf_.size() < elementCount) {
        vertexOf_.resize(elementCount);
        stampOf_.resize(elementCount, 0);
    }
    ++stamp_;
    for (auto& triangle : part.triangles) {
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
    const bool wantsUv = part.hasUv[0] || part.hasUv[1];
    readVertices(primitive, where, placement, elements, part);
    if (wantsUv && !part.hasUv[0] && !part.hasUv[1])
        warnings_.add(fmt::format("{} has a texture but no texture coordinates for it.", where));

    for (auto& triangle : part.triangles) {
        if (part.vertices[triangle[0]].mirrored) std::swap(triangle[1], triangle[2]);
    }
    const size_t dropped = std::erase_if(part.triangles, [&](const auto& triangle) {
        return !std::all_of(triangle.begin(), triangle.end(),
                            [&](uint32_t v) { return isFinite(part.vertices[v].position); });
    });
    if (dropped > 0) warnings_.add("Dropped a triangle with a vertex that is not finite.", dropped);

    const auto hasNormal = [](const Vertex& vertex) { return vertex.normal != glm::dvec3(0); };
    const auto without = part.vertices.size() -
                         static_cast<size_t>(std::count_if(part.vertices.begin(), part.vertices.end(), hasNormal));
    if (!flat && without > 0)
        warnings_.add("Replaced a normal that has no direction by that of the triangles.", without);
    completeNormals(part);
    if (part.hasTangents) completeTangents(part, material.normalTexture);
    return part;
}

void completeNormals(MeshPart& part)
{
    std::vector<glm::dvec3> sums(part.vertices.size(), glm::dvec3(0)); // weighted by area
    for (const auto& [a, b, c] : part.triangles) {
        const glm::dvec3& origin = part.vertices[a].position;
        const glm::dvec3 area = glm::cross(part.vertices[b].position - origin, part.vertices[c].position - origin);
        for (const uint32_t v : {a, b, c}) sums[v] += area;
    }
    for (size_t v = 0; v < part.vertices.size(); ++v) {
        glm::dvec3& normal = part.vertices[v].normal;
        if (normal == glm::dvec3(0)) normal = unitOrZero(sums[v]);
        if (normal == glm::dvec3(0)) normal = {0, 0, 1}; // of no triangle with an area
    }
}

} // namespace scene::gltf
