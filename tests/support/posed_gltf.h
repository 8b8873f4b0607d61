#pragma once
// Where the triangles of an animated glTF file are at a time: written from the specification in float64, with nothing
// of the product. Slow and trusting; for the sample models.

#include <array>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

class PosedGltf
{
  public:
    explicit PosedGltf(const std::filesystem::path& file); // .gltf with .bin beside it, or .glb

    size_t animationCount() const { return json_.contains("animations") ? json_["animations"].size() : 0; }
    double seconds(size_t animation) const; // the time of its last key

    // In the order of the nodes (each before its children, children in their order), primitives and indices. Where two
    // animations move the same, the first of them does.
    std::vector<std::array<glm::dvec3, 3>> triangles(const std::vector<size_t>& animations, double seconds) const;

  private:
    using Numbers = std::vector<double>;
    using Pose = nlohmann::json; // the nodes, with translation, rotation, scale and weights as they are then

    double component(const nlohmann::json& accessor, size_t element, size_t c) const;
    Numbers numbers(size_t accessor) const;
    Numbers valueAt(const nlohmann::json& sampler, bool rotation, double seconds) const;
    Pose poseAt(const std::vector<size_t>& animations, double seconds) const;
    void addMesh(const nlohmann::json& node, const std::vector<glm::dmat4>& world, size_t index,
                 std::vector<std::array<glm::dvec3, 3>>& result) const;

    nlohmann::json json_;
    std::vector<std::vector<unsigned char>> buffers_;
};
