#include "tests/hunt/case_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/image/image.h"
#include "engine/scene/environment.h"
#include "engine/scene/gltf_loader.h"
#include "tests/support/base64.h"

namespace hunt
{

namespace
{

using Json = nlohmann::ordered_json;
using scene::Material, scene::Scene, scene::TextureUse;

std::vector<std::byte> pngOf(const scene::Image& source)
{
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = source.width;
    image.height = source.height;
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
    png_alloc_size_t size = bytes.size();
    const int written = png_image_write_to_memory(&image, bytes.data(), &size, 0, source.rgba.data(), 0, nullptr);
    CHECK(written != 0);
    bytes.resize(size);
    return bytes;
}

class Writer
{
  public:
    explicit Writer(const Scene& scene) : scene_(scene) {}

    Json document()
    {
        json_["asset"] = {{"version", "2.0"}};
        json_["scene"] = 0;
        addGeometry();
        addMaterials();
        addCamera();
        addLights();
        Json nodes = Json::array();
        for (size_t i = 0; i < json_["nodes"].size(); ++i) nodes.push_back(i);
        json_["scenes"] = {{{"nodes", nodes}}};
        json_["buffers"] = {
            {{"byteLength", data_.size()}, {"uri", "data:application/octet-stream;base64," + support::base64(data_)}}};
        if (!extensions_.empty()) json_["extensionsUsed"] = extensions_;
        return json_;
    }

  private:
    int view(std::span<const std::byte> bytes)
    {
        data_.resize((data_.size() + 3) / 4 * 4);
        json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
        data_.insert(data_.end(), bytes.begin(), bytes.end());
        return int(json_["bufferViews"].size()) - 1;
    }
    template <class T>
    int accessor(const std::vector<T>& values, const char* type, int component = 5126)
    {
        Json accessor = {{"bufferView", view(std::as_bytes(std::span(values)))},
                         {"componentType", component},
                         {"count", values.size()},
                         {"type", type}};
        json_["accessors"].push_back(accessor);
        return int(json_["accessors"].size()) - 1;
    }

    void addGeometry()
    {
        Json attributes = {{"POSITION", accessor(scene_.positions, "VEC3")}};
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (const glm::vec3& p : scene_.positions) low = glm::min(low, p), high = glm::max(high, p);
        json_["accessors"][0]["min"] = {low.x, low.y, low.z};
        json_["accessors"][0]["max"] = {high.x, high.y, high.z};
        attributes["NORMAL"] = accessor(scene_.normals, "VEC3");
        if (!scene_.tangents.empty()) attributes["TANGENT"] = accessor(scene_.tangents, "VEC4");
        if (!scene_.uv0.empty()) attributes["TEXCOORD_0"] = accessor(scene_.uv0, "VEC2");
        if (!scene_.uv1.empty()) attributes["TEXCOORD_1"] = accessor(scene_.uv1, "VEC2");
        if (!scene_.colors.empty()) attributes["COLOR_0"] = accessor(scene_.colors, "VEC4");
        Json primitives = Json::array();
        for (uint32_t m = 0; m < scene_.materials.size(); ++m) {
            std::vector<uint32_t> indices;
            for (const scene::Triangle& triangle : scene_.triangles)
                if (triangle.material == m)
                    indices.insert(indices.end(), triangle.vertices.begin(), triangle.vertices.end());
            if (indices.empty()) continue;
            primitives.push_back(
                {{"attributes", attributes}, {"indices", accessor(indices, "SCALAR", 5125)}, {"material", m}});
        }
        json_["meshes"] = {{{"primitives", primitives}}};
        json_["nodes"].push_back({{"mesh", 0}});
    }

    Json textureOf(const TextureUse& use)
    {
        constexpr int WRAPS[] = {10497, 33071, 33648};
        json_["samplers"].push_back({{"wrapS", WRAPS[size_t(use.wrapU)]},
                                     {"wrapT", WRAPS[size_t(use.wrapV)]},
                                     {"magFilter", use.nearest ? 9728 : 9729}});
        json_["textures"].push_back({{"source", use.image}, {"sampler", json_["samplers"].size() - 1}});
        Json info = {{"index", json_["textures"].size() - 1}, {"texCoord", use.uvSet}};
        if (use.row0 != TextureUse().row0 || use.row1 != TextureUse().row1) {
            // rotation() * scale(), as the loader reads it: columns (cos, -sin) s and (sin, cos) t
            const double s = std::hypot(double(use.row0.x), double(use.row1.x)),
                         t = std::hypot(double(use.row0.y), double(use.row1.y));
            const double angle = std::atan2(-double(use.row1.x), double(use.row0.x));
            info["extensions"]["KHR_texture_transform"] = {
                {"offset", {use.row0.z, use.row1.z}}, {"rotation", angle}, {"scale", {s, t}}};
            extensions_.emplace("KHR_texture_transform");
        }
        return info;
    }

    void addMaterials()
    {
        // What adds to the document comes first: references into it do not last.
        for (const scene::Image& image : scene_.images) {
            const int bytes = view(pngOf(image));
            json_["images"].push_back({{"bufferView", bytes}, {"mimeType", "image/png"}});
        }
        Json materials = Json::array();
        for (const Material& m : scene_.materials) materials.push_back(materialOf(m));
        json_["materials"] = materials;
    }

    Json materialOf(const Material& m)
    {
        constexpr const char* ALPHA[] = {"OPAQUE", "MASK", "BLEND"};
        const auto color = [](const glm::dvec3& c) { return Json{c.x, c.y, c.z}; };
        Json json = {{"name", m.name}, {"doubleSided", m.doubleSided}, {"alphaMode", ALPHA[size_t(m.alpha)]}};
        if (m.alpha == scene::Alpha::Mask) json["alphaCutoff"] = m.alphaCutoff;
        Json& pbr = json["pbrMetallicRoughness"];
        pbr = {{"baseColorFactor", {m.baseColor.r, m.baseColor.g, m.baseColor.b, m.baseColor.a}},
               {"metallicFactor", m.metallic},
               {"roughnessFactor", m.roughness}};
        const auto use = [&](Json& object, const char* key, const TextureUse& texture) {
            if (texture.image != scene::NONE) object[key] = textureOf(texture);
        };
        use(pbr, "baseColorTexture", m.baseColorTexture);
        use(pbr, "metallicRoughnessTexture", m.metallicRoughnessTexture);
        use(json, "normalTexture", m.normalTexture);
        if (m.normalTexture.image != scene::NONE) json["normalTexture"]["scale"] = m.normalScale;
        use(json, "emissiveTexture", m.emissiveTexture);
        const double strength = double(std::max(m.emission.r, std::max(m.emission.g, m.emission.b)));
        if (strength > 0) {
            json["emissiveFactor"] = color(glm::dvec3(m.emission) / strength);
            extension(json, "KHR_materials_emissive_strength") = {{"emissiveStrength", strength}};
        }
        if (m.unlit) extension(json, "KHR_materials_unlit") = Json::object();
        if (m.ior != 1.5f) extension(json, "KHR_materials_ior") = {{"ior", m.ior}};
        Json& specular = extension(json, "KHR_materials_specular");
        specular = {{"specularFactor", m.specular}, {"specularColorFactor", color(m.specularColor)}};
        use(specular, "specularTexture", m.specularTexture);
        use(specular, "specularColorTexture", m.specularColorTexture);
        if (m.transmission > 0) {
            Json& transmission = extension(json, "KHR_materials_transmission");
            transmission = {{"transmissionFactor", m.transmission}};
            use(transmission, "transmissionTexture", m.transmissionTexture);
            if (!m.thin) extension(json, "KHR_materials_volume") = {{"thicknessFactor", 1}};
        }
        return json;
    }
    Json& extension(Json& object, const char* name)
    {
        extensions_.emplace(name);
        return object["extensions"][name];
    }

    // Looking along `forward`, -z of the node.
    static Json placed(const glm::dvec3& at, const glm::dvec3& right, const glm::dvec3& up, const glm::dvec3& forward)
    {
        return {{"matrix",
                 {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, -forward.x, -forward.y, -forward.z, 0, at.x, at.y,
                  at.z, 1}}};
    }

    void addCamera()
    {
        const scene::Camera& camera = scene_.cameras.at(0);
        Json json;
        if (camera.orthographic)
            json = {{"type", "orthographic"},
                    {"orthographic", {{"xmag", camera.ymag}, {"ymag", camera.ymag}, {"znear", 0.001}, {"zfar", 1000}}}};
        else
            json = {{"type", "perspective"}, {"perspective", {{"yfov", camera.yfov}, {"znear", 0.001}}}};
        json_["cameras"] = {json};
        Json node = placed(camera.position, camera.right, camera.up, camera.forward);
        node["camera"] = 0;
        json_["nodes"].push_back(node);
    }

    void addLights()
    {
        constexpr const char* TYPES[] = {"point", "spot", "directional"};
        for (const scene::PunctualLight& light : scene_.lights) {
            const double strength = double(std::max(light.intensity.r, std::max(light.intensity.g, light.intensity.b)));
            const glm::dvec3 color = strength > 0 ? glm::dvec3(light.intensity) / strength : glm::dvec3(1);
            Json json = {
                {"type", TYPES[size_t(light.kind)]}, {"intensity", strength}, {"color", {color.r, color.g, color.b}}};
            if (light.kind == scene::LightKind::Spot)
                json["spot"] = {{"innerConeAngle", light.innerConeAngle}, {"outerConeAngle", light.outerConeAngle}};
            json_["extensions"]["KHR_lights_punctual"]["lights"].push_back(json);
            const glm::dvec3 forward(light.direction);
            const glm::dvec3 right =
                glm::normalize(cross(forward, std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
            Json node = placed(glm::dvec3(light.position), right, cross(right, forward), forward);
            node["extensions"]["KHR_lights_punctual"]["light"] =
                json_["extensions"]["KHR_lights_punctual"]["lights"].size() - 1;
            json_["nodes"].push_back(node);
            extensions_.emplace("KHR_lights_punctual");
        }
    }

    const Scene& scene_;
    Json json_;
    std::vector<std::byte> data_;
    std::set<std::string> extensions_;
};

void write(const std::filesystem::path& file, const std::string& text)
{
    files::writeAtomically(file, std::as_bytes(std::span(text)));
}

template <int N>
std::array<float, size_t(N)> listOf(const glm::vec<N, float>& v)
{
    std::array<float, size_t(N)> list;
    for (int i = 0; i < N; ++i) list[size_t(i)] = v[i];
    return list;
}
template <int N>
void readInto(glm::vec<N, float>& v, const Json& list)
{
    for (int i = 0; i < N; ++i) v[i] = list.at(size_t(i)).get<float>();
}

Json jsonOf(const Move& move)
{
    return {{"what", WHAT_NAMES[size_t(move.what)]},
            {"when", WHEN_NAMES[size_t(move.when)]},
            {"frames", move.frames},
            {"reversed", move.reversed},
            {"target", move.target},
            {"center", listOf(move.center)},
            {"slide", listOf(move.slide)},
            {"turn", listOf(move.turn)},
            {"stretch", listOf(move.stretch)},
            {"color", listOf(move.color)},
            {"emission", listOf(move.emission)},
            {"roughness", move.roughness},
            {"metallic", move.metallic}};
}

// Throws Error.
uint32_t indexOf(const auto& names, const Json& name)
{
    const auto at = std::ranges::find(names, name.get<std::string>());
    if (at == std::end(names)) throw Error("\"{}\" in the file of a case is unknown.", name.get<std::string>());
    return uint32_t(at - std::begin(names));
}

Move moveOf(const Json& json)
{
    Move move{.what = Move::What(indexOf(WHAT_NAMES, json.at("what"))),
              .when = Move::When(indexOf(WHEN_NAMES, json.at("when"))),
              .frames = json.at("frames").get<uint32_t>(),
              .reversed = json.at("reversed").get<bool>(),
              .target = json.at("target").get<uint32_t>(),
              .roughness = json.at("roughness").get<float>(),
              .metallic = json.at("metallic").get<float>()};
    readInto(move.center, json.at("center"));
    readInto(move.slide, json.at("slide"));
    readInto(move.turn, json.at("turn"));
    readInto(move.stretch, json.at("stretch"));
    readInto(move.color, json.at("color"));
    readInto(move.emission, json.at("emission"));
    return move;
}

// What `trichrome render` takes: the method on trial after its frames, and many frames of the path tracer. It does not
// know of moves and of what the hunter stores once.
std::vector<std::string> commandsOf(const std::string& name, const Case& c)
{
    if (!c.moves.empty() || c.stores) return {fmt::format("hunt --file {}.json", name)};
    const auto usual = passes::toText(passes::Settings{});
    const auto line = [&](const passes::Settings& settings, const std::string& output, double orbit) {
        std::string text = fmt::format("trichrome render {}.gltf -o {}", name, output);
        const auto mine = passes::toText(settings);
        for (size_t i = 0; i < mine.size(); ++i)
            if (mine[i] != usual[i] || mine[i].first == "method")
                text += fmt::format(" --{} {}", mine[i].first, mine[i].second);
        if (orbit != 0) text += fmt::format(" --orbit {}", orbit);
        return text;
    };
    passes::Settings truth = c.settings;
    truth.method = passes::Method::Pt;
    truth.frames = 100000;
    truth.average = true;
    passes::Settings trial = c.settings;
    trial.average = c.orbit == 0;
    if (trial.average) trial.frames = 10000; // at rest frames add up to a mean
    std::vector<std::string> lines = {line(trial, "tried.exr", c.orbit)};
    if (c.truth == Truth::PathTracer && c.orbit == 0) lines.push_back(line(truth, "truth.exr", 0));
    return lines;
}

} // namespace

void writeCase(const std::filesystem::path& stem, const Case& c, const std::string& finding)
{
    std::filesystem::create_directories(stem.parent_path());
    const std::string name = stem.filename().string();
    write(stem.string() + ".gltf", Writer(c.scene).document().dump());
    Case named = c;
    const scene::Environment& sky = c.scene.environment;
    if (sky.width > 0) {
        image::Image picture = {sky.width, sky.height, sky.radiance}; // azimuth 0 is its middle
        for (auto row = picture.pixels.begin(); row != picture.pixels.end(); row += sky.width)
            std::rotate(row, row + (sky.width - sky.width / 2), row + sky.width);
        image::write(stem.string() + ".exr", picture, {});
        named.settings.environment = name + ".exr";
    }
    Json json;
    json["finding"] = finding;
    json["kind"] = KIND_NAMES[size_t(c.kind)];
    json["truth"] = TRUTH_NAMES[size_t(c.truth)];
    json["orbit"] = c.orbit;
    if (c.stores) json["stores"] = true;
    const glm::dvec3& target = c.scene.cameras.at(0).target; // which glTF does not know
    json["target"] = {target.x, target.y, target.z};
    for (const Move& move : c.moves) json["moves"].push_back(jsonOf(move));
    json["settings"] = passes::toJson(named.settings);
    json["commands"] = commandsOf(name, named);
    write(stem.string() + ".json", json.dump(2) + "\n");
}

Case readCase(const std::filesystem::path& file)
{
    const std::vector<std::byte> bytes = files::read(file);
    const Json json = Json::parse(reinterpret_cast<const char*>(bytes.data()),
                                  reinterpret_cast<const char*>(bytes.data()) + bytes.size());
    Case c;
    c.kind = Kind(indexOf(KIND_NAMES, json.at("kind")));
    c.truth = Truth(indexOf(TRUTH_NAMES, json.at("truth")));
    c.orbit = json.at("orbit").get<double>();
    c.stores = json.value("stores", false);
    passes::apply(c.settings, json.at("settings"));
    std::filesystem::path scene = file;
    c.scene = scene::loadGltf(scene.replace_extension(".gltf"), {.sky = false});
    if (json.contains("target")) // older files are without
        for (int i = 0; i < 3; ++i)
            c.scene.cameras.at(0).target[i] = json["target"][size_t(i)].get<double>() - c.scene.origin[i];
    for (const Json& move : json.value("moves", Json::array())) {
        c.moves.push_back(moveOf(move));
        c.moves.back().center -= glm::vec3(c.scene.origin);
    }
    if (!c.settings.environment.empty())
        scene::setEnvironment(c.scene, (file.parent_path() / c.settings.environment).string(),
                              c.settings.environmentScale);
    c.settings.environment.clear(); // it is in the scene now
    return c;
}

} // namespace hunt
