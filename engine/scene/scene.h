#pragma once
// A scene as plain data, one flat world with transforms applied, but for meshes that are stored once and stand in many
// places. Loaders and generators fill it, Bvh and GpuScene read it. Units: metres, radians, radiance W/(sr m^2) per
// channel (linear Rec. 709 primaries).

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace scene
{

constexpr uint32_t NONE = 0xffffffffu;

struct Motion; // engine/scene/motion.h

enum class Wrap : uint32_t { Repeat, Clamp, Mirror };

// RGBA, row 0 first (v = 0 is the top row, as in glTF): 8 bits a sample, or 16 where a file needs them.
struct Image {
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba;  // 4 * width * height; colour images are sRGB-encoded
    std::vector<uint16_t> deep; // the same instead of `rgba`, when not empty

    // Of texel i / 4 in rows, channel i % 4: 0 to 1.
    double sample(size_t i) const { return deep.empty() ? rgba[i] / 255.0 : deep[i] / 65535.0; }
    size_t sampleCount() const { return size_t{4} * width * height; }
};

// One use of an image by a material: where to look, and how.
struct TextureUse {
    uint32_t image = NONE; // index into Scene::images
    uint32_t uvSet = 0;    // 0 or 1
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    bool nearest = false; // else bilinear
    // KHR_texture_transform: uv' = (row0 . (u,v,1), row1 . (u,v,1))
    glm::vec3 row0 = {1, 0, 0};
    glm::vec3 row1 = {0, 1, 0};
};

enum class Alpha : uint32_t { Opaque, Mask, Blend };

// glTF 2.0 metallic-roughness. docs/LIGHT_TRANSPORT.md says what each number means to the integral.
struct Material {
    std::string name;
    glm::vec4 baseColor = {1, 1, 1, 1}; // linear; a is alpha
    float metallic = 1;
    float roughness = 1;            // alpha = roughness^2
    glm::vec3 emission = {0, 0, 0}; // emissiveFactor * emissiveStrength, radiance
    float normalScale = 1;
    float ior = 1.5f;
    float specular = 1;                  // KHR_materials_specular: weight of the dielectric specular lobe
    glm::vec3 specularColor = {1, 1, 1}; // and its tint at normal incidence
    float transmission = 0;              // KHR_materials_transmission
    bool thin = true;                    // thin-walled: no refraction. false: KHR_materials_volume with thickness > 0
    Alpha alpha = Alpha::Opaque;
    float alphaCutoff = 0.5f;            // Mask only
    bool doubleSided = false;            // emission leaves both sides; scattering is two-sided always
    bool unlit = false;                  // KHR_materials_unlit: shows baseColor, scatters nothing
    TextureUse baseColorTexture;         // sRGB, a linear
    TextureUse metallicRoughnessTexture; // g roughness, b metallic
    TextureUse normalTexture;
    TextureUse emissiveTexture;      // sRGB
    TextureUse transmissionTexture;  // r
    TextureUse specularTexture;      // a
    TextureUse specularColorTexture; // sRGB
};

struct Triangle {
    std::array<uint32_t, 3> vertices = {0, 0,
                                        0}; // counter-clockwise seen from the front, also after mirroring transforms
    uint32_t material = 0;
};

enum class LightKind : uint32_t { Point, Spot, Directional };

struct PunctualLight {
    std::string name;
    LightKind kind = LightKind::Point;
    glm::vec3 intensity = {1, 1, 1};  // colour * intensity: W/sr (point, spot), W/m^2 (directional)
    glm::vec3 position = {0, 0, 0};   // world, relative to Scene::origin
    glm::vec3 direction = {0, 0, -1}; // unit, where the light goes
    float innerConeAngle = 0;         // radians, spot only
    float outerConeAngle = 0.785398f;
};

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov = 0.8;         // radians, perspective, full angle
    double aspect = 0;         // of the glTF camera; 0: none. The picture's own aspect wins (vertical field is kept)
    double xmag = 1, ymag = 1; // orthographic half extents
    glm::dvec3 position = {0, 0, 0}; // relative to Scene::origin
    glm::dvec3 right = {1, 0, 0};    // unit, orthogonal
    glm::dvec3 up = {0, 1, 0};
    glm::dvec3 forward = {0, 0, -1};
    glm::dvec3 target = {0, 0, -1}; // what an orbit turns around, relative to Scene::origin
    bool operator==(const Camera&) const = default;
};

// Equirectangular radiance, row 0 is +y (up), column 0 starts at azimuth 0; empty when width is 0.
// Direction of (u, v) in [0,1)^2: theta = pi v from +y, phi = 2 pi u: (sin theta cos phi, cos theta, sin theta sin
// phi).
struct Environment {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<glm::vec3> radiance; // width * height
};

// Vertices and the triangles between them. positions and normals are always there; the rest is empty when no vertex has
// it, else as long as positions.
struct Geometry {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // unit, shading
    std::vector<glm::vec4> tangents; // unit, w is the handedness
    std::vector<glm::vec2> uv0;
    std::vector<glm::vec2> uv1;
    std::vector<glm::vec4> colors; // linear, multiplies baseColor
    std::vector<Triangle> triangles;
};

// Where one of Scene::meshes stands. The transform is not singular (engine/scene/instances.h: suitsInstance()).
struct Instance {
    uint32_t mesh = 0;
    glm::dmat4 worldFromMesh = glm::dmat4(1); // world relative to Scene::origin
    bool visible = true;
};

struct Scene : Geometry { // in the world
    std::string name;
    glm::dvec3 origin = {0, 0, 0};   // world position of (0,0,0): the box's centre, subtracted in float64
    std::vector<Geometry> meshes;    // stored once, around the origins of spaces of their own; none emits
    std::vector<Instance> instances; // of them

    std::vector<Material> materials; // at least one when there are triangles
    std::vector<Image> images;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras; // at least one after loading
    Environment environment;
    std::shared_ptr<const Motion> motion;     // what moves, and how; none: nothing does
    std::vector<std::string> warnings;        // sentences for the person, in order
    std::vector<std::filesystem::path> files; // that belong to it beside its own: buffers and textures
};

// Those that a triangle has, of the world or of a mesh that is stored once.
std::vector<bool> usedMaterials(const Scene& scene);

} // namespace scene
