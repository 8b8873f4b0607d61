#pragma once
// What moves in a scene, beside the flat scene that it is made from: the nodes with their rest transforms, meshes in
// their own space, skins, lights, cameras, materials, and the animations (glTF 2.0, 3.5 to 3.11). pose() writes the
// flat scene of a time. Loaders and generators fill it; what does not move is not in it.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/animation.h"
#include "engine/scene/mesh.h"
#include "engine/scene/placing.h"
#include "engine/scene/scene.h"

namespace scene
{

struct Motion {
    // One that moves, or that something below refers to.
    struct Node {
        uint32_t parent = NONE;                     // an earlier one here; NONE: it stands still
        glm::dmat4 worldFromParent = glm::dmat4(1); // where `parent` is NONE
        Transform rest;
        bool visible = true;         // KHR_node_visibility; its ancestors must be, too
        std::vector<double> weights; // of its mesh's morph targets
    };
    struct Skin {
        std::vector<uint32_t> joints;            // nodes
        std::vector<glm::dmat4> inverseBindings; // joint from mesh, by joint
    };
    // One primitive of one mesh at one place: vertices and triangles that follow each other in the flat scene, in every
    // pose the same ones in the same order. Where a triangle's transform mirrors, its corners 1 and 2 change places;
    // where it has no area, or is not finite at rest, it is its first corner three times; where the part is hidden, the
    // part's first vertex.
    struct Part {
        std::string name; // for messages: meshes[0].primitives[1] at nodes[3]
        uint32_t node = 0;
        uint32_t mesh = 0;                           // several may share one
        uint32_t skin = NONE;                        // NONE: rigid, but for its morph targets
        glm::dmat4 nodeFromMesh = glm::dmat4(1);     // EXT_mesh_gpu_instancing
        uint32_t firstVertex = 0, firstTriangle = 0; // in the flat scene
    };
    // A mesh that is stored once, in a place that moves rigidly.
    struct PlacedInstance {
        uint32_t instance = 0; // Scene::instances
        uint32_t node = 0;
        glm::dmat4 nodeFromMesh = glm::dmat4(1);
    };
    struct PlacedLight {
        uint32_t light = 0;   // Scene::lights. Hidden or without a direction, its intensity is 0
        uint32_t node = NONE; // NONE: it stands still
        uint32_t lamp = 0;    // several may share one
    };
    struct Lens {
        double yfov = 0.8;         // radians
        double xmag = 1, ymag = 1; // orthographic
    };
    struct PlacedCamera {
        uint32_t camera = 0;  // Scene::cameras. Without a direction it stays where it was at rest
        uint32_t node = NONE; // NONE: it stands still
        uint32_t lens = 0;
        Camera rest;
    };
    struct Paint {
        uint32_t material = 0; // Scene::materials
        glm::dvec4 baseColor = {1, 1, 1, 1};
        double metallic = 1, roughness = 1;
        glm::dvec3 emissiveFactor = {0, 0, 0};
        double emissiveStrength = 1;
    };

    std::vector<Animation> animations;
    std::vector<std::vector<float>> numbers; // keys and values of the channels, which may share them
    std::vector<Node> nodes;                 // parents first
    std::vector<Skin> skins;
    std::vector<Mesh> meshes;
    std::vector<Part> parts;
    std::vector<PlacedInstance> instances;
    std::vector<Lamp> lamps;
    std::vector<PlacedLight> lights;
    std::vector<Lens> lenses;
    std::vector<PlacedCamera> cameras;
    std::vector<Paint> paints;
    double radius = 1; // of the scene at rest, meters; says how far from it cameras aim

    uint64_t bytes() const;       // that it takes, roughly
    uint64_t fingerprint() const; // of all that poses depend on, beside the flat scene
};

// Which animations a choice means: "off", "all", else that name, else its index. Throws Error: there is none, or it
// cannot be played.
std::vector<uint32_t> chooseAnimations(const Scene& scene, const std::string& choice);

// Whether two of them move the same property of the same object: then the first one does.
bool contested(const Motion& motion, std::span<const uint32_t> animations);

// The flat scene as these animations (indices; none: at rest) have it at `seconds`. It depends on nothing else: what
// moves is written anew, whatever the scene's pose was. Scene::origin, the counts of vertices, triangles, instances,
// lights, cameras and materials and their order are those of rest. Without Scene::motion nothing changes. Throws Error,
// and leaves the pose unfinished, where something is too far away or, unless at rest, not finite.
void pose(Scene& scene, std::span<const uint32_t> animations, double seconds);

} // namespace scene
