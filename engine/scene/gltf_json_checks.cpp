// The order of the checks is that of the references: buffers, views, accessors, then what uses accessors, then nodes.

#include "engine/scene/gltf_json_checks.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <string_view>
#include <vector>

#include "engine/scene/gltf_materials.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_BYTES = (uint64_t{1} << 31) - 1;     // of one buffer; offsets then fit every integer type
constexpr uint64_t MAX_SPARSE_ELEMENTS = uint64_t{1} << 26; // of all accessors together: bounds overlapping sparse data

constexpr uint64_t UNSIGNED_BYTE = 5121, UNSIGNED_SHORT = 5123, UNSIGNED_INT = 5125, FLOAT = 5126;

// Beside those of materials.
constexpr std::array<std::string_view, 6> SUPPORTED_EXTENSIONS = {"EXT_mesh_gpu_instancing", "KHR_animation_pointer",
                                                                  "KHR_lights_punctual",     "KHR_mesh_quantization",
                                                                  "KHR_node_visibility",     "KHR_texture_transform"};

void checkAsset(const Object& document)
{
    document.requiredObject("asset", [](const Object& asset) {
        const auto version = [&](const char* key) {
            std::array<unsigned, 2> numbers = {2, 0};
            const std::string* text = asset.string(key);
            char rest = 0;
            if (text && std::sscanf(text->c_str(), "%3u.%3u%c", &numbers[0], &numbers[1], &rest) != 2)
                throw Error("asset.{} is \"{}\", not a version like 2.0.", key, shown(*text));
            return numbers;
        };
        if (!asset.has("version")) throw Error("asset lacks \"version\".");
        if (version("version")[0] != 2)
            throw Error("asset.version is {}, but only glTF 2 is supported.", shown(*asset.string("version")));
        if (version("minVersion") > std::array{2u, 0u})
            throw Error("asset.minVersion is {}, newer than the supported 2.0.", shown(*asset.string("minVersion")));
    });
}

void checkExtensions(const Object& document)
{
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        for (size_t i = 0; i < document.arraySize(key); ++i) {
            if (!document.json()[key][i].is_string()) throw Error("{}[{}] is not a string.", key, i);
            const std::string& name = document.json()[key][i].get_ref<const std::string&>();
            if (key == std::string_view("extensionsRequired") && !isSupportedExtension(name))
                throw Error("The file requires the extension \"{}\", which is not supported.", shown(name));
        }
    }
}

void checkBuffers(const Object& document)
{
    document.eachObject("buffers", [](const Object& buffer, size_t) {
        buffer.required("byteLength", buffer.integer("byteLength", 1, MAX_BYTES));
        buffer.string("uri");
    });
}

void checkBufferViews(const Object& document)
{
    document.eachObject("bufferViews", [&](const Object& view, size_t) {
        const uint32_t buffer = view.required("buffer", view.index("buffer", "buffers"));
        const uint64_t available = document.at("buffers", buffer).integer("byteLength", 1, MAX_BYTES).value();
        const uint64_t offset = view.integer("byteOffset", 0, MAX_BYTES).value_or(0);
        const uint64_t length = view.required("byteLength", view.integer("byteLength", 1, MAX_BYTES));
        if (offset + length > available)
            throw Error("{} ends at byte {}, but its buffer has {} bytes.", view.path(), offset + length, available);
        const uint64_t stride = view.integer("byteStride", 4, 252).value_or(4);
        if (stride % 4 != 0) throw Error("{} is {}, not a multiple of 4.", view.path("byteStride"), stride);
    });
}

// `count` elements of `size` bytes from `offset` on must lie inside the view; without a stride they are packed.
void checkRange(const Object& user, const Object& view, uint64_t count, uint64_t size, bool strided)
{
    const uint64_t offset = user.integer("byteOffset", 0, MAX_BYTES).value_or(0);
    const uint64_t length = view.integer("byteLength", 1, MAX_BYTES).value();
    const uint64_t stride = strided ? view.integer("byteStride", 4, 252).value_or(size) : size;
    if (stride < size)
        throw Error("{} is {}, smaller than an element of {} ({} bytes).", view.path("byteStride"), stride, user.path(),
                    size);
    const uint64_t end = offset + (count - 1) * stride + size;
    if (end > length)
        throw Error("{} ends at byte {} of its buffer view, which has {} bytes.", user.path(), end, length);
}

void checkAlignment(const Object& user, const Object& view, uint64_t unit)
{
    const uint64_t start =
        user.integer("byteOffset", 0, MAX_BYTES).value_or(0) + view.integer("byteOffset", 0, MAX_BYTES).value_or(0);
    if (start % unit != 0)
        throw Error("{} starts at byte {}, not a multiple of its component size {}.", user.path(), start, unit);
}

void checkSparse(const Object& document, const Object& sparse, uint64_t accessorCount, uint64_t size, uint64_t& budget)
{
    const uint64_t count = sparse.required("count", sparse.integer("count", 1, accessorCount));
    if (count > budget)
        throw Error("{} exceeds the limit of {} sparse elements in a file.", sparse.path(), MAX_SPARSE_ELEMENTS);
    budget -= count;
    const auto viewOf = [&](const Object& part) {
        return document.at("bufferViews", part.required("bufferView", part.index("bufferView", "bufferViews")));
    };
    sparse.requiredObject("indices", [&](const Object& indices) {
        const uint64_t type =
            indices.required("componentType", indices.integer("componentType", UNSIGNED_BYTE, UNSIGNED_INT));
        if (type != UNSIGNED_BYTE && type != UNSIGNED_SHORT && type != UNSIGNED_INT)
            throw Error("{} is {}, not an unsigned integer type.", indices.path("componentType"), type);
        checkRange(indices, viewOf(indices), count, componentSize(type), false);
        checkAlignment(indices, viewOf(indices), componentSize(type));
    });
    sparse.requiredObject("values",
                          [&](const Object& values) { checkRange(values, viewOf(values), count, size, false); });
}

void checkAccessors(const Object& document)
{
    uint64_t sparseBudget = MAX_SPARSE_ELEMENTS;
    document.eachObject("accessors", [&](const Object& accessor, size_t) {
        const uint64_t componentType = accessor.required("componentType", accessor.integer("componentType", 0, 0xffff));
        if (componentSize(componentType) == 0)
            throw Error("{} is {}, not a glTF component type.", accessor.path("componentType"), componentType);
        const std::string* type = accessor.string("type");
        if (!type) throw Error("{} lacks \"type\".", accessor.path());
        if (componentCount(*type) == 0)
            throw Error("{} is \"{}\", not a glTF type.", accessor.path("type"), shown(*type));
        accessor.boolean("normalized");

        const uint64_t count = accessor.required("count", accessor.integer("count", 1, MAX_BYTES));
        const uint64_t size = elementSize(componentType, *type);
        accessor.integer("byteOffset", 0, MAX_BYTES);
        if (const auto index = accessor.index("bufferView", "bufferViews")) {
            const Object view = document.at("bufferViews", *index);
            checkRange(accessor, view, count, size, true);
            checkAlignment(accessor, view, componentSize(componentType));
        }
        accessor.object("sparse",
                        [&](const Object& sparse) { checkSparse(document, sparse, count, size, sparseBudget); });
    });
}

// What a vertex attribute's accessor may hold. Integers of KHR_mesh_quantization are accepted for all of them.
bool isUsableType(const std::string& attribute, const std::string& type, uint64_t componentType)
{
    if (attribute == "POSITION" || attribute == "NORMAL") return type == "VEC3";
    if (attribute == "TANGENT") return type == "VEC4" || type == "VEC3"; // morph targets have no w
    if (attribute.starts_with("TEXCOORD_")) return type == "VEC2";
    if (attribute.starts_with("COLOR_")) return type == "VEC3" || type == "VEC4";
    if (attribute.starts_with("JOINTS_"))
        return type == "VEC4" && (componentType == UNSIGNED_BYTE || componentType == UNSIGNED_SHORT);
    if (attribute.starts_with("WEIGHTS_")) return type == "VEC4";
    return true;
}

// The accessors of an attribute dictionary: as many elements each, of types that can serve.
void checkAttributes(const Object& document, const Object& attributes, std::optional<uint64_t>& count)
{
    for (const auto& [name, unused] : attributes.json().items()) {
        const Object accessor = document.at("accessors", attributes.index(name, "accessors").value());
        const uint64_t elements = accessor.integer("count", 1, MAX_BYTES).value();
        if (elements != count.value_or(elements))
            throw Error("{} has {} elements, but other attributes of the primitive have {}.", attributes.path(name),
                        elements, *count);
        count = elements;
        const std::string& type = *accessor.string("type");
        if (!isUsableType(name, type, accessor.integer("componentType", 0, 0xffff).value()))
            throw Error("{} cannot be of type {} ({}).", attributes.path(name), type,
                        accessor.json()["componentType"].dump());
    }
}

void checkPrimitive(const Object& document, const Object& primitive)
{
    std::optional<uint64_t> count;
    primitive.requiredObject("attributes", [&](const Object& attributes) {
        checkAttributes(document, attributes, count);
        for (const char* set : {"0", "1", "2", "3"}) {
            const std::string joints = std::string("JOINTS_") + set, weights = std::string("WEIGHTS_") + set;
            if (attributes.json().contains(joints) != attributes.json().contains(weights))
                throw Error("{} has only one of {} and {}.", attributes.path(), joints, weights);
        }
    });
    primitive.eachObject("targets", [&](const Object& target, size_t) { checkAttributes(document, target, count); });
    primitive.integer("mode", 0, 6);
    primitive.index("material", "materials");
    if (const auto indices = primitive.index("indices", "accessors")) {
        const Object accessor = document.at("accessors", *indices);
        const uint64_t type = accessor.integer("componentType", 0, 0xffff).value();
        if (*accessor.string("type") != "SCALAR" ||
            (type != UNSIGNED_BYTE && type != UNSIGNED_SHORT && type != UNSIGNED_INT))
            throw Error("{} refers to an accessor of {} {}, not of unsigned integers.", primitive.path("indices"),
                        *accessor.string("type"), type);
        if (!accessor.has("bufferView"))
            throw Error("{} refers to an accessor without a buffer view.", primitive.path("indices"));
    }
}

void checkMeshes(const Object& document)
{
    document.eachObject("meshes", [&](const Object& mesh, size_t) {
        mesh.string("name");
        mesh.numbers("weights", 0);
        if (!mesh.has("primitives")) throw Error("{} lacks \"primitives\".", mesh.path());
        mesh.eachObject("primitives", [&](const Object& primitive, size_t) { checkPrimitive(document, primitive); });
    });
}

void checkCamerasAndLights(const Object& document)
{
    document.eachObject("cameras", [](const Object& camera, size_t) {
        camera.string("name");
        const std::string* type = camera.string("type");
        if (!type) throw Error("{} lacks \"type\".", camera.path());
        const auto positive = [](const Object& lens, const char* key) {
            const double value = lens.required(key, lens.number(key));
            if (!(value > 0)) throw Error("{} is {}, but must be above 0.", lens.path(key), value);
            return value;
        };
        if (*type == "perspective") {
            camera.requiredObject("perspective", [&](const Object& lens) {
                // Above, the picture's half height would overflow: tan(yfov / 2) has its pole at pi.
                if (positive(lens, "yfov") > std::numbers::pi - 1e-3)
                    throw Error("{} is {}, but must be below pi.", lens.path("yfov"), *lens.number("yfov"));
                lens.required("znear", lens.number("znear"));
                lens.number("zfar");
                lens.number("aspectRatio");
            });
        } else if (*type == "orthographic") {
            camera.requiredObject("orthographic", [&](const Object& lens) {
                positive(lens, "xmag");
                positive(lens, "ymag");
                lens.required("znear", lens.number("znear"));
                lens.required("zfar", lens.number("zfar"));
            });
        } else {
            throw Error("{} is \"{}\", not perspective or orthographic.", camera.path("type"), shown(*type));
        }
    });

    document.extension("KHR_lights_punctual", [](const Object& list) {
        list.eachObject("lights", [](const Object& light, size_t) {
            light.string("name");
            light.number("intensity");
            light.numbers("color", 3);
            const std::string* type = light.string("type");
            if (!type) throw Error("{} lacks \"type\".", light.path());
            if (*type != "point" && *type != "spot" && *type != "directional")
                throw Error("{} is \"{}\", not point, spot or directional.", light.path("type"), shown(*type));
            if (*type != "spot") return;
            light.requiredObject("spot", [](const Object& spot) {
                spot.number("innerConeAngle");
                spot.number("outerConeAngle");
            });
        });
    });
}

void checkInstancing(const Object& document, const Object& instancing)
{
    std::optional<uint64_t> count;
    instancing.requiredObject("attributes", [&](const Object& attributes) {
        for (const auto& [name, unused] : attributes.json().items()) {
            const Object accessor = document.at("accessors", attributes.index(name, "accessors").value());
            const uint64_t elements = accessor.integer("count", 1, ~uint64_t{0}).value();
            if (elements != count.value_or(elements))
                throw Error("{} has {} elements, but other attributes have {}.", attributes.path(name), elements,
                            *count);
            count = elements;
            const char* type = name == "ROTATION" ? "VEC4" : "VEC3";
            if ((name == "TRANSLATION" || name == "ROTATION" || name == "SCALE") && *accessor.string("type") != type)
                throw Error("{} refers to an accessor of {} instead of {}.", attributes.path(name),
                            *accessor.string("type"), type);
            // Without data every instance would stand at the same place, as many as a number in the file says.
            if (!accessor.has("bufferView"))
                throw Error("{} refers to an accessor without a buffer view.", attributes.path(name));
        }
    });
}

void checkNodes(const Object& document)
{
    const size_t lights = lightCount(document);
    constexpr uint32_t NO_PARENT = ~0u;
    std::vector<uint32_t> parents(document.arraySize("nodes"), NO_PARENT);
    document.eachObject("nodes", [&](const Object& node, size_t i) {
        node.string("name");
        node.numbers("matrix", 16);
        node.numbers("translation", 3);
        node.numbers("rotation", 4);
        node.numbers("scale", 3);
        node.numbers("weights", 0);
        node.index("mesh", "meshes");
        node.index("camera", "cameras");
        node.index("skin", "skins");
        node.extension("KHR_lights_punctual",
                       [&](const Object& use) { use.required("light", use.index("light", lights, "lights")); });
        node.extension("KHR_node_visibility", [&](const Object& use) { use.boolean("visible"); });
        node.extension("EXT_mesh_gpu_instancing", [&](const Object& use) { checkInstancing(document, use); });
        node.eachIndex("children", "nodes", [&](uint32_t child) {
            if (parents[child] != NO_PARENT)
                throw Error("nodes[{}] is a child of both nodes[{}] and nodes[{}].", child, parents[child], i);
            parents[child] = static_cast<uint32_t>(i);
        });
    });

    // With one parent each, the nodes form a forest unless some are their own ancestors. Climb from each node until a
    // node known to hang from a root; a climb that meets its own trail has found a cycle.
    constexpr uint32_t ROOTED = ~0u;
    std::vector<uint32_t> trail(parents.size(), 0); // 0: not seen, else 1 + the node whose climb passed here
    for (uint32_t start = 0; start < parents.size(); ++start) {
        uint32_t at = start;
        while (at != NO_PARENT && trail[at] == 0) {
            trail[at] = start + 1;
            at = parents[at];
        }
        if (at != NO_PARENT && trail[at] == start + 1) throw Error("nodes[{}] is among its own descendants.", at);
        for (at = start; at != NO_PARENT && trail[at] == start + 1; at = parents[at]) trail[at] = ROOTED;
    }

    document.eachObject("scenes", [](const Object& scene, size_t) {
        scene.string("name");
        scene.eachIndex("nodes", "nodes", [](uint32_t) {});
    });
    document.index("scene", "scenes");
}

void checkSkins(const Object& document)
{
    document.eachObject("skins", [&](const Object& skin, size_t) {
        if (skin.arraySize("joints") == 0) throw Error("{} has no joints.", skin.path());
        skin.eachIndex("joints", "nodes", [](uint32_t) {});
        skin.index("skeleton", "nodes");
        const auto matrices = skin.index("inverseBindMatrices", "accessors");
        if (!matrices) return;
        const Object accessor = document.at("accessors", *matrices);
        if (*accessor.string("type") != "MAT4" || accessor.integer("componentType", 0, 0xffff) != FLOAT)
            throw Error("{} refers to an accessor that is not of float MAT4.", skin.path("inverseBindMatrices"));
        if (accessor.integer("count", 1, MAX_BYTES) < skin.arraySize("joints"))
            throw Error("{} has {} matrices for {} joints.", skin.path("inverseBindMatrices"),
                        *accessor.integer("count", 1, MAX_BYTES), skin.arraySize("joints"));
    });
}

void checkAnimations(const Object& document)
{
    const auto countOf = [&](uint32_t accessor) {
        return document.at("accessors", accessor).integer("count", 1, MAX_BYTES).value();
    };
    document.eachObject("animations", [&](const Object& animation, size_t) {
        animation.string("name");
        animation.eachObject("samplers", [&](const Object& sampler, size_t) {
            const uint64_t keys = countOf(sampler.required("input", sampler.index("input", "accessors")));
            const uint64_t outputs = countOf(sampler.required("output", sampler.index("output", "accessors")));
            const std::string* interpolation = sampler.string("interpolation");
            const uint64_t perKey = interpolation && *interpolation == "CUBICSPLINE" ? 3 : 1;
            if (outputs < keys * perKey) // weights have more: one for each morph target
                throw Error("{} has {} outputs for {} keys, fewer than {} for each.", sampler.path(), outputs, keys,
                            perKey);
        });
        animation.eachObject("channels", [&](const Object& channel, size_t) {
            channel.required("sampler",
                             channel.index("sampler", animation.arraySize("samplers"), "samplers in this animation"));
            channel.requiredObject("target", [](const Object& target) {
                target.index("node", "nodes");
                target.string("path");
            });
        });
    });
}

} // namespace

size_t lightCount(const Object& document)
{
    size_t count = 0;
    document.extension("KHR_lights_punctual", [&](const Object& list) { count = list.arraySize("lights"); });
    return count;
}

bool isSupportedExtension(const std::string& name)
{
    return isMaterialExtension(name) || std::ranges::find(SUPPORTED_EXTENSIONS, name) != SUPPORTED_EXTENSIONS.end();
}

uint32_t componentSize(uint64_t componentType)
{
    switch (componentType) {
    case 5120:
    case UNSIGNED_BYTE: return 1;
    case 5122:
    case UNSIGNED_SHORT: return 2;
    case UNSIGNED_INT:
    case FLOAT: return 4;
    default: return 0;
    }
}

uint32_t componentCount(const std::string& type)
{
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

uint32_t elementSize(uint64_t componentType, const std::string& type)
{
    const uint32_t size = componentSize(componentType);
    if (type == "MAT2" && size == 1) return 8; // columns start at multiples of 4 bytes
    if (type == "MAT3" && size <= 2) return 12 * size;
    return size * componentCount(type);
}

void checkJson(const Json& json)
{
    const Object document(json);
    checkAsset(document);
    checkExtensions(document);
    checkBuffers(document);
    checkBufferViews(document);
    checkAccessors(document);
    checkMeshes(document);
    checkCamerasAndLights(document);
    checkSkins(document);
    checkNodes(document);
    checkAnimations(document);
}

} // namespace scene::gltf
