#include "tests/hunt/shrink.h"

#include <algorithm>

namespace hunt
{

namespace
{

using scene::Material, scene::Scene;

// Vertices and materials that nothing uses any more go, and so does what moved them.
void tidy(Case& c)
{
    Scene& scene = c.scene;
    std::vector<uint32_t> newVertex(scene.positions.size(), scene::NONE),
        newMaterial(scene.materials.size(), scene::NONE);
    std::vector<uint32_t> kept;
    std::vector<Material> materials;
    for (scene::Triangle& triangle : scene.triangles) {
        for (uint32_t& vertex : triangle.vertices) {
            if (newVertex[vertex] == scene::NONE) {
                newVertex[vertex] = uint32_t(kept.size());
                kept.push_back(vertex);
            }
            vertex = newVertex[vertex];
        }
        uint32_t& index = newMaterial[triangle.material];
        if (index == scene::NONE) {
            index = uint32_t(materials.size());
            materials.push_back(scene.materials[triangle.material]);
        }
        triangle.material = index;
    }
    const auto keep = [&](auto& values) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> old;
        old.swap(values);
        for (const uint32_t vertex : kept) values.push_back(old[vertex]);
    };
    keep(scene.positions);
    keep(scene.normals);
    keep(scene.tangents);
    keep(scene.uv0);
    keep(scene.uv1);
    keep(scene.colors);
    scene.materials = materials;
    for (Move& move : c.moves)
        if (move.what != Move::What::Light) move.target = newMaterial[move.target];
    std::erase_if(c.moves, [](const Move& move) { return move.target == scene::NONE; });
}

void eraseLight(Case& c, uint32_t light)
{
    c.scene.lights.erase(c.scene.lights.begin() + light);
    std::erase_if(c.moves, [&](const Move& m) { return m.what == Move::What::Light && m.target == light; });
    for (Move& move : c.moves) move.target -= move.what == Move::What::Light && move.target > light;
}

bool hasNoArea(const Scene& scene, const scene::Triangle& triangle)
{
    const auto corner = [&](size_t i) { return scene.positions[triangle.vertices[i]]; };
    return cross(corner(1) - corner(0), corner(2) - corner(0)) == glm::vec3(0);
}

class Shrinker
{
  public:
    Shrinker(Case& c, const std::function<bool(const Case&)>& fails, const std::function<bool()>& stop)
        : case_(c), fails_(fails), stop_(stop)
    {
    }

    void run()
    {
        attempt([](Case& c) {
            std::erase_if(c.scene.triangles, [&](const scene::Triangle& t) { return hasNoArea(c.scene, t); });
            tidy(c);
        });
        bool smaller = true;
        while (smaller && !stop_()) {
            const Case before = case_;
            settings();
            moves();
            lights();
            triangles();
            materials();
            smaller = sizeOf(case_) < sizeOf(before);
        }
    }

  private:
    static size_t sizeOf(const Case& c)
    {
        size_t unusual = 0;
        for (const Material& m : c.scene.materials) unusual += m.roughness != 1 || m.specular != 0 || m.metallic != 0;
        return c.scene.triangles.size() + c.scene.lights.size() + c.scene.environment.radiance.size() + unusual +
               c.settings.spatial + c.settings.frames + c.settings.maxBounces + (c.orbit != 0) + c.stores +
               c.moves.size();
    }

    // Takes the change when the case still fails.
    template <class Change>
    bool attempt(Change&& change)
    {
        if (stop_()) return false;
        Case smaller = case_;
        change(smaller);
        if (smaller.scene.triangles.empty() || !fails_(smaller)) return false;
        case_ = smaller;
        return true;
    }

    void settings()
    {
        const passes::Settings usual;
        if (case_.orbit != 0) attempt([](Case& c) { c.orbit = 0; });
        if (case_.stores) attempt([](Case& c) { c.stores = false; });
        if (case_.settings.spatial > 0) attempt([](Case& c) { c.settings.spatial = 0; });
        if (case_.settings.spatial > 1) attempt([](Case& c) { c.settings.spatial = 1; });
        if (case_.settings.temporal && case_.settings.frames > 1)
            attempt([](Case& c) {
                c.settings.temporal = false;
                c.settings.frames = 1;
            });
        while (case_.settings.frames > 2 && attempt([](Case& c) { c.settings.frames = (c.settings.frames + 1) / 2; })) {
        }
        while (case_.settings.maxBounces > 0 && attempt([](Case& c) { --c.settings.maxBounces; })) {
        }
        // The default of every other choice, those of the future too.
        const auto words = passes::toText(usual);
        for (const auto& [name, word] : words) {
            const auto mine = passes::toText(case_.settings);
            const auto same = std::ranges::find(mine, std::pair(name, word)) != mine.end();
            if (same || name == "method" || name == "size" || name == "average" || name == "frames" ||
                name == "temporal" || name == "spatial" || name == "max-bounces" || name == "seed")
                continue;
            attempt([&name = name, &word = word](Case& c) { passes::set(c.settings, name, word); });
        }
    }

    void moves()
    {
        for (size_t i = case_.moves.size(); i-- > 0;)
            if (!attempt([&](Case& c) { c.moves.erase(c.moves.begin() + std::ptrdiff_t(i)); })) simplify(i);
    }

    void simplify(size_t i)
    {
        const auto without = [&](auto Move::*part) {
            const auto none = Move().*part;
            if (case_.moves[i].*part != none) attempt([&](Case& c) { c.moves[i].*part = none; });
        };
        without(&Move::reversed);
        if (case_.moves[i].what == Move::What::Wobble) return; // the rest is one
        without(&Move::slide);
        without(&Move::turn);
        without(&Move::stretch);
    }

    void lights()
    {
        for (uint32_t i = uint32_t(case_.scene.lights.size()); i-- > 0;) attempt([&](Case& c) { eraseLight(c, i); });
        if (case_.scene.environment.width > 0) {
            attempt([](Case& c) { c.scene.environment = {}; });
            if (case_.scene.environment.radiance.size() > 1)
                attempt([](Case& c) { c.scene.environment = {1, 1, {glm::vec3(1)}}; });
        }
    }

    // In halves, quarters and so on, down to single ones.
    void triangles()
    {
        for (size_t part = case_.scene.triangles.size() / 2; part > 0 && !stop_(); part /= 2)
            for (size_t first = case_.scene.triangles.size() / part; first-- > 0;)
                attempt([&](Case& c) {
                    auto& all = c.scene.triangles;
                    const auto begin = all.begin() + std::ptrdiff_t(std::min(first * part, all.size()));
                    all.erase(begin, begin + std::ptrdiff_t(std::min(part, size_t(all.end() - begin))));
                    tidy(c);
                });
    }

    void materials()
    {
        const auto untextured = [](Material& m) {
            m.baseColorTexture = m.metallicRoughnessTexture = m.normalTexture = m.emissiveTexture =
                m.transmissionTexture = m.specularTexture = m.specularColorTexture = {};
        };
        attempt([&](Case& c) {
            for (Material& m : c.scene.materials) untextured(m);
            c.scene.images.clear();
            c.scene.uv0.clear();
            c.scene.uv1.clear();
            c.scene.tangents.clear();
        });
        if (!case_.scene.colors.empty()) attempt([](Case& c) { c.scene.colors.clear(); });
        for (size_t i = 0; i < case_.scene.materials.size(); ++i) {
            const Material& m = case_.scene.materials[i];
            const Material plain = {.name = "plain",
                                    .baseColor = {0.5, 0.5, 0.5, m.baseColor.a},
                                    .metallic = 0,
                                    .emission = m.emission,
                                    .specular = 0,
                                    .alpha = m.alpha,
                                    .alphaCutoff = m.alphaCutoff};
            if (m.metallic == 0 && m.specular == 0 && m.transmission == 0 && !m.unlit && !m.doubleSided) continue;
            attempt([&](Case& c) { c.scene.materials[i] = plain; });
        }
    }

    Case& case_;
    const std::function<bool(const Case&)>& fails_;
    const std::function<bool()>& stop_;
};

} // namespace

Case shrink(Case c, const std::function<bool(const Case&)>& fails, const std::function<bool()>& stop)
{
    Shrinker(c, fails, stop).run();
    return c;
}

} // namespace hunt
