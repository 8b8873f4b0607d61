#include "engine/scene/gltf_scene_checks.h"

#include <numbers>
#include <vector>

namespace scene::gltf
{

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

    document.object("extensions", [](const Object& extensions) {
        extensions.object("KHR_lights_punctual", [](const Object& list) {
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
    });
}

namespace
{

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

size_t lightCount(const Object& document)
{
    size_t count = 0;
    document.object("extensions", [&](const Object& extensions) {
        extensions.object("KHR_lights_punctual", [&](const Object& list) { count = list.arraySize("lights"); });
    });
    return count;
}

} // namespace

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
        node.object("extensions", [&](const Object& extensions) {
            extensions.object("KHR_lights_punctual",
                              [&](const Object& use) { use.required("light", use.index("light", lights, "lights")); });
            extensions.object("KHR_node_visibility", [&](const Object& use) { use.boolean("visible"); });
            extensions.object("EXT_mesh_gpu_instancing", [&](const Object& use) { checkInstancing(document, use); });
        });
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

} // namespace scene::gltf
