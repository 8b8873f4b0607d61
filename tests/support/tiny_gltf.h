#pragma once
// Small glTF files made in code: start from one triangle, change the JSON, load.
//
//     TinyGltf file;
//     file.json["nodes"][0]["scale"] = {-1, 1, 1};
//     const scene::Scene scene = file.load();

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/scene/gltf_loader.h"

class TinyGltf
{
  public:
    // One node with one mesh: the triangle (0,0,0), (1,0,0), (0,1,0), with normals +z.
    TinyGltf();
    ~TinyGltf();
    TinyGltf(const TinyGltf&) = delete;
    TinyGltf& operator=(const TinyGltf&) = delete;

    // A new buffer view of these values; its index.
    template <class T>
    int view(const std::vector<T>& values)
    {
        return viewOfBytes(std::as_bytes(std::span(values)));
    }
    // A new accessor of `type` ("VEC3") over a view of its own; its index. `values` are its components.
    template <class T>
    int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false)
    {
        const nlohmann::json accessor = {{"bufferView", view(values)},
                                         {"componentType", componentTypeOf(T())},
                                         {"count", values.size() / componentsOf(type)},
                                         {"type", type},
                                         {"normalized", normalized}};
        json["accessors"].push_back(accessor);
        return int(json["accessors"].size()) - 1;
    }
    // A texture of its own image of 2 x 2 pixels, row by row from the top, each 0xrrggbb; its index.
    int texture(const std::vector<uint32_t>& pixels);

    // A channel of the first animation: {{"node", 0}, {"path", "translation"}} has these values, of `type`, at these
    // times.
    void animate(const nlohmann::json& target, const std::vector<float>& times, const std::vector<float>& values,
                 const std::string& type, const std::string& interpolation = "LINEAR");
    // The same by KHR_animation_pointer.
    void animatePointer(const std::string& pointer, const std::vector<float>& times, const std::vector<float>& values,
                        const std::string& type, const std::string& interpolation = "LINEAR");

    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
    nlohmann::json& attributes() { return primitive()["attributes"]; }
    nlohmann::json& material(); // of the triangle; made on first use

    scene::Scene load(const scene::LoadOptions& options = {}) const;
    std::string text() const;  // one self-contained .gltf file
    std::string error() const; // what load() throws, without the file's name; "" when it does not
    bool warns(const std::string& sentence) const;

    nlohmann::json json;
    std::filesystem::path folder; // where the file will be; removed at the end

  private:
    static int componentTypeOf(int8_t) { return 5120; }
    static int componentTypeOf(uint8_t) { return 5121; }
    static int componentTypeOf(int16_t) { return 5122; }
    static int componentTypeOf(uint16_t) { return 5123; }
    static int componentTypeOf(uint32_t) { return 5125; }
    static int componentTypeOf(float) { return 5126; }
    static size_t componentsOf(const std::string& type);
    int viewOfBytes(std::span<const std::byte> bytes);

    std::vector<std::byte> data_;
};
