#include "tests/support/posed_gltf.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

namespace
{

using Json = nlohmann::json;

std::vector<unsigned char> bytesOf(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error("no file " + file.string());
    return {std::istreambuf_iterator<char>(stream), {}};
}

template <class T>
double load(const unsigned char* from)
{
    T value;
    std::memcpy(&value, from, sizeof value);
    return double(value);
}

size_t componentsOf(const Json& accessor)
{
    const std::string type = accessor["type"];
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
}

double length(const std::vector<double>& q)
{
    double sum = 0;
    for (const double x : q) sum += x * x;
    return std::sqrt(sum);
}

// 3.5.3: M = T * R * S, the rotation's matrix written out.
glm::dmat4 localOf(const Json& node)
{
    glm::dmat4 m(1);
    if (node.contains("matrix")) {
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node["matrix"][size_t(i)];
        return m;
    }
    const auto get = [&](const char* key, const std::vector<double>& absent) {
        return node.contains(key) ? node[key].get<std::vector<double>>() : absent;
    };
    const auto t = get("translation", {0, 0, 0}), s = get("scale", {1, 1, 1});
    auto q = get("rotation", {0, 0, 0, 1});
    const double size = length(q);
    for (double& x : q) x /= size;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) m[column][row] = rows[row][column] * s[size_t(column)];
    for (int row = 0; row < 3; ++row) m[3][row] = t[size_t(row)];
    return m;
}

} // namespace

PosedGltf::PosedGltf(const std::filesystem::path& file)
{
    std::vector<unsigned char> bytes = bytesOf(file);
    if (file.extension() == ".glb") { // 4.4: a header of 12 bytes, then chunks of length, type and bytes
        const auto word = [&](size_t at) {
            uint32_t value = 0;
            std::memcpy(&value, &bytes[at], 4);
            return size_t(value);
        };
        const size_t text = word(12), binary = 20 + text;
        json_ = Json::parse(bytes.begin() + 20, bytes.begin() + std::ptrdiff_t(20 + text));
        const auto begin = bytes.begin() + std::ptrdiff_t(binary + 8);
        buffers_.emplace_back(begin, begin + std::ptrdiff_t(word(binary)));
        return;
    }
    json_ = Json::parse(bytes);
    for (const Json& buffer : json_["buffers"])
        buffers_.push_back(bytesOf(file.parent_path() / buffer["uri"].get<std::string>()));
}

double PosedGltf::component(const Json& accessor, size_t element, size_t c) const
{
    const Json& view = json_["bufferViews"][accessor["bufferView"].get<size_t>()];
    const int type = accessor["componentType"];
    const size_t size = type == 5126 || type == 5125 ? 4 : type == 5122 || type == 5123 ? 2 : 1;
    const size_t stride = view.value("byteStride", size * componentsOf(accessor));
    const unsigned char* from = buffers_[view["buffer"].get<size_t>()].data() + view.value("byteOffset", size_t{0}) +
                                accessor.value("byteOffset", size_t{0}) + element * stride + c * size;
    const bool normalized = accessor.value("normalized", false);
    switch (type) { // 3.6.2.2 and 3.11: normalized integers
    case 5120: return normalized ? std::max(load<int8_t>(from) / 127, -1.0) : load<int8_t>(from);
    case 5121: return load<uint8_t>(from) / (normalized ? 255 : 1);
    case 5122: return normalized ? std::max(load<int16_t>(from) / 32767, -1.0) : load<int16_t>(from);
    case 5123: return load<uint16_t>(from) / (normalized ? 65535 : 1);
    case 5125: return load<uint32_t>(from);
    default: return load<float>(from);
    }
}

PosedGltf::Numbers PosedGltf::numbers(size_t index) const
{
    const Json& accessor = json_["accessors"][index];
    const size_t width = componentsOf(accessor), count = accessor["count"];
    Numbers all(count * width, 0);
    if (accessor.contains("bufferView"))
        for (size_t i = 0; i < all.size(); ++i) all[i] = component(accessor, i / width, i % width);
    if (!accessor.contains("sparse")) return all;
    const auto part = [&](const char* key, const Json& type, size_t i, size_t c) {
        Json view = accessor["sparse"][key];
        view["type"] = type;
        if (!view.contains("componentType")) view["componentType"] = accessor["componentType"];
        return component(view, i, c);
    };
    for (size_t i = 0; i < accessor["sparse"]["count"].get<size_t>(); ++i)
        for (size_t c = 0; c < width; ++c)
            all[size_t(part("indices", "SCALAR", i, 0)) * width + c] = part("values", accessor["type"], i, c);
    return all;
}

double PosedGltf::seconds(size_t animation) const
{
    double last = 0;
    for (const Json& sampler : json_["animations"][animation]["samplers"])
        last = std::max(last, numbers(sampler["input"]).back());
    return last;
}

// Appendix C, formula by formula.
PosedGltf::Numbers PosedGltf::valueAt(const Json& sampler, bool rotation, double seconds) const
{
    const Numbers times = numbers(sampler["input"]), all = numbers(sampler["output"]);
    const std::string mode = sampler.value("interpolation", "LINEAR");
    const bool cubic = mode == "CUBICSPLINE";
    const size_t width = all.size() / times.size() / (cubic ? 3 : 1);
    const auto element = [&](size_t key, size_t which) { // in-tangent, value, out-tangent
        const auto from = all.begin() + std::ptrdiff_t((cubic ? 3 * key + which : key) * width);
        return Numbers(from, from + std::ptrdiff_t(width));
    };
    if (seconds <= times.front()) return element(0, 1);
    if (seconds >= times.back()) return element(times.size() - 1, 1);
    size_t k = 0;
    while (times[k + 1] <= seconds) ++k;
    if (mode == "STEP") return element(k, 1);
    const double span = times[k + 1] - times[k], t = (seconds - times[k]) / span;
    const Numbers from = element(k, 1), to = element(k + 1, 1);
    Numbers value(width);
    if (cubic) {
        const Numbers out = element(k, 2), in = element(k + 1, 0);
        for (size_t c = 0; c < width; ++c)
            value[c] = (2 * t * t * t - 3 * t * t + 1) * from[c] + span * (t * t * t - 2 * t * t + t) * out[c] +
                       (-2 * t * t * t + 3 * t * t) * to[c] + span * (t * t * t - t * t) * in[c];
    } else if (rotation) {
        double d = 0;
        for (size_t c = 0; c < 4; ++c) d += from[c] * to[c] / length(from) / length(to);
        const double a = std::acos(std::min(1.0, std::abs(d))), s = d < 0 ? -1 : 1;
        for (size_t c = 0; c < 4; ++c)
            value[c] = a < 1e-9 ? from[c]
                                : std::sin(a * (1 - t)) / std::sin(a) * from[c] / length(from) +
                                      s * std::sin(a * t) / std::sin(a) * to[c] / length(to);
    } else {
        for (size_t c = 0; c < width; ++c) value[c] = (1 - t) * from[c] + t * to[c];
    }
    return value;
}

PosedGltf::Pose PosedGltf::poseAt(const std::vector<size_t>& animations, double seconds) const
{
    Pose nodes = json_["nodes"];
    for (size_t i = animations.size(); i-- > 0;) {
        const Json& animation = json_["animations"][animations[i]];
        for (const Json& channel : animation["channels"]) {
            const std::string path = channel["target"]["path"];
            nodes[channel["target"]["node"].get<size_t>()][path] =
                valueAt(animation["samplers"][channel["sampler"].get<size_t>()], path == "rotation", seconds);
        }
    }
    return nodes;
}

void PosedGltf::addMesh(const Json& node, const std::vector<glm::dmat4>& world, size_t index,
                        std::vector<std::array<glm::dvec3, 3>>& result) const
{
    const Json& mesh = json_["meshes"][node["mesh"].get<size_t>()];
    const Json weights = node.contains("weights") ? node["weights"] : mesh.value("weights", Json::array());
    for (const Json& primitive : mesh["primitives"]) {
        const Json& attributes = primitive["attributes"];
        Numbers positions = numbers(attributes["POSITION"]);
        for (size_t t = 0; primitive.contains("targets") && t < primitive["targets"].size(); ++t) {
            if (!primitive["targets"][t].contains("POSITION") || t >= weights.size()) continue;
            const Numbers moved = numbers(primitive["targets"][t]["POSITION"]);
            for (size_t i = 0; i < positions.size(); ++i) positions[i] += weights[t].get<double>() * moved[i];
        }
        // Each joint takes the point with it; the node's own transform does nothing (3.7.3.3).
        std::vector<glm::dmat4> joints;
        Numbers jointOf, shares;
        if (node.contains("skin")) {
            const Json& skin = json_["skins"][node["skin"].get<size_t>()];
            Numbers inverses;
            if (skin.contains("inverseBindMatrices")) inverses = numbers(skin["inverseBindMatrices"]);
            for (size_t j = 0; j < skin["joints"].size(); ++j) {
                glm::dmat4 inverse(1);
                for (size_t i = 0; i < 16 && !inverses.empty(); ++i)
                    inverse[int(i / 4)][int(i % 4)] = inverses[16 * j + i];
                joints.push_back(world[skin["joints"][j].get<size_t>()] * inverse);
            }
            jointOf = numbers(attributes["JOINTS_0"]);
            shares = numbers(attributes["WEIGHTS_0"]);
        }
        std::vector<glm::dvec3> placed;
        for (size_t v = 0; v < positions.size() / 3; ++v) {
            const glm::dvec4 p(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 1);
            glm::dvec4 sum(0);
            if (node.contains("skin")) {
                double total = 0;
                for (size_t c = 4 * v; c < 4 * v + 4; ++c) {
                    sum += shares[c] * (joints[size_t(jointOf[c])] * p);
                    total += shares[c];
                }
                sum /= total;
            } else {
                sum = world[index] * p;
            }
            placed.emplace_back(sum);
        }
        if (primitive.value("mode", 4) != 4) throw std::runtime_error("only lists of triangles");
        Numbers corners;
        if (primitive.contains("indices"))
            corners = numbers(primitive["indices"]);
        else
            for (size_t i = 0; i < placed.size(); ++i) corners.push_back(double(i));
        for (size_t i = 0; i + 2 < corners.size(); i += 3) {
            const auto a = size_t(corners[i]), b = size_t(corners[i + 1]), c = size_t(corners[i + 2]);
            if (a != b && b != c && c != a) result.push_back({placed[a], placed[b], placed[c]});
        }
    }
}

std::vector<std::array<glm::dvec3, 3>> PosedGltf::triangles(const std::vector<size_t>& animations, double seconds) const
{
    const Pose nodes = poseAt(animations, seconds);
    std::vector<glm::dmat4> world(nodes.size(), glm::dmat4(1));
    std::vector<size_t> order;
    const std::function<void(size_t, const glm::dmat4&)> visit = [&](size_t i, const glm::dmat4& parent) {
        world[i] = parent * localOf(nodes[i]);
        order.push_back(i);
        for (const Json& child : nodes[i].value("children", Json::array())) visit(child.get<size_t>(), world[i]);
    };
    for (const Json& root : json_["scenes"][json_.value("scene", size_t{0})]["nodes"])
        visit(root.get<size_t>(), glm::dmat4(1));
    std::vector<std::array<glm::dvec3, 3>> result;
    for (const size_t i : order)
        if (nodes[i].contains("mesh")) addMesh(nodes[i], world, i, result);
    return result;
}
