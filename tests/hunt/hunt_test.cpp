// Does the hunter find what is wrong, and nothing else? Its verdicts on numbers of known law, its files, its shrinking;
// then a short hunt with a fixed seed, and what earlier hunts have found.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/environment.h"
#include "engine/scene/scene_tables.h"
#include "engine/scene/shapes.h"
#include "tests/hunt/case_file.h"
#include "tests/hunt/shrink.h"
#include "tests/hunt/trial.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/planted_shaders.h"

namespace hunt
{
namespace
{

// ------------------------------------------------------------------------------------------------------------ verdicts
struct Law {
    const char* name;
    std::function<double(Draw&)> value; // with the mean 1
};
void PrintTo(const Law& law, std::ostream* os)
{
    *os << law.name;
}

double gaussian(Draw& draw)
{
    return std::sqrt(-2 * std::log(1 - draw.uniform())) * std::cos(2 * std::numbers::pi * draw.uniform());
}

Law rare(const char* name, double probability) // dim, but for a flash that carries half of all light
{
    return {name, [=](Draw& d) { return 0.5 + (d.chance(probability) ? 0.5 / probability : 0); }};
}

Law pareto(const char* name, double exponent)
{
    return {name, [=](Draw& d) { return std::pow(1 - d.uniform(), -1 / exponent) * (exponent - 1) / exponent; }};
}

const std::vector<Law> LAWS = {
    {"Gaussian", [](Draw& d) { return 1 + 0.5 * gaussian(d); }},
    {"Exponential", [](Draw& d) { return -std::log(1 - d.uniform()); }},
    {"LogNormal1", [](Draw& d) { return std::exp(gaussian(d) - 0.5); }},
    {"LogNormal2", [](Draw& d) { return std::exp(2 * gaussian(d) - 2); }},
    pareto("Pareto3", 3),
    pareto("Pareto1_5", 1.5),
    pareto("Pareto1_2", 1.2),
    {"Reciprocal", [](Draw& d) { return 0.5 + 0.5 * std::min(1 / (1 - d.uniform()), 1e6) / (1 + std::log(1e6)); }},
    rare("Flash1e2", 1e-2),
    rare("Flash1e3", 1e-3),
    rare("Flash1e4", 1e-4),
    rare("Flash1e5", 1e-5),
};

// As Examination goes about it (trial.cpp), on one quantity.
Answer sequence(const Law& law, const Law& trueLaw, double trueMean, Draw& draw)
{
    constexpr size_t RUNS[] = {256, 1024, 8192}, FRAMES[] = {2048, 8192, 65536};
    Answer answer = Answer::Differ;
    for (size_t stage = 0; stage < 3 && answer == Answer::Differ; ++stage) {
        answer = Answer::Agree;
        Values tried, truth;
        for (size_t run = 0; run < RUNS[stage]; ++run) tried.add(law.value(draw));
        for (size_t frame = 0; frame < FRAMES[stage]; ++frame) truth.add(trueMean * trueLaw.value(draw));
        tried.finish(1);
        truth.finish(1);
        answer = stage == 2 ? compare(tried, truth, LEVELS[2], 5e-4).answer
                            : compare(tried.estimate, truth.estimate, LEVELS[stage], 5e-4).answer;
    }
    return answer;
}

class Verdicts : public testing::TestWithParam<Law>
{
};

// In 6000 sequences of each law none; their tails make a first suspicion common.
TEST_P(Verdicts, RaiseNoFalseAlarm)
{
    size_t undecided = 0;
    for (uint64_t i = 0; i < 6000; ++i) {
        Draw draw{17, i};
        const Answer answer = sequence(GetParam(), GetParam(), 1, draw);
        EXPECT_NE(answer, Answer::Differ) << "sequence " << i;
        undecided += answer == Answer::Undecided;
    }
    RecordProperty("undecided", int(undecided));
}
INSTANTIATE_TEST_SUITE_P(Of, Verdicts, testing::ValuesIn(LAWS), [](const auto& i) { return i.param.name; });

// The last test alone, of which the family's level holds most: no alarm where undersampling passes for a difference.
// With 4096 values of a flash of 1e-4 the flash is missed altogether two times in three.
TEST(Verdict, OfTheLastTestHoldsWhereFlashesAreMissed)
{
    for (const Law& law : LAWS)
        for (uint64_t i = 0; i < 40; ++i) {
            Draw draw{23, i};
            Values tried, truth;
            for (int run = 0; run < 4096; ++run) tried.add(law.value(draw));
            for (int frame = 0; frame < 65536; ++frame) truth.add(law.value(draw));
            tried.finish(1);
            truth.finish(1);
            EXPECT_NE(compare(tried, truth, LEVELS[2], 5e-4).answer, Answer::Differ) << law.name << " " << i;
        }
}

// Resampling may have a tail that path tracing has not.
TEST(Verdict, HoldsWhereOneSideAloneHasATail)
{
    for (const Law& law : LAWS) {
        if (std::string(law.name).starts_with("Flash")) continue; // of which nothing would tell
        for (uint64_t i = 0; i < 1000; ++i) {
            Draw draw{29, i};
            EXPECT_NE(sequence(law, LAWS[0], 1, draw), Answer::Differ) << law.name << " " << i;
        }
    }
}

// Of a third, which these laws show with 256 values.
TEST(Verdict, FindsBiases)
{
    constexpr size_t LEAST[] = {20, 15, 5}; // of 20, by law: their spreads are 0.5, 1 and 1.3
    for (const double truth : {0.7, 1.4})
        for (size_t law = 0; law < std::size(LEAST); ++law) {
            Draw draw{5, law};
            size_t found = 0;
            for (int i = 0; i < 20; ++i) found += sequence(LAWS[law], LAWS[law], truth, draw) == Answer::Differ;
            EXPECT_GE(found, LEAST[law]) << LAWS[law].name << " " << truth;
        }
}

TEST(Verdict, RoundingIsNoDifference)
{
    Values a, b;
    for (int i = 0; i < 100; ++i) a.add(1), b.add(1.0004);
    a.finish(1);
    b.finish(1);
    EXPECT_EQ(compare(a, b, LEVELS[2], 5e-4).answer, Answer::Agree);
    EXPECT_EQ(compare(a, b, LEVELS[2], 3e-4).answer, Answer::Differ); // a constant is known exactly
}

// A path tracer that has hardly picked a lamp knows nothing of it, however many values it has.
TEST(Verdict, NeedsChances)
{
    Values tried, truth;
    for (int i = 0; i < 10000; ++i) tried.add(0);
    truth.estimate = {1e-6, 1e-18, 1e4};
    truth.chances = 1e6;
    tried.finish(1e-3);
    EXPECT_EQ(compare(tried, truth, LEVELS[2], 5e-4).answer, Answer::Undecided);
    tried.finish(1e-2);
    EXPECT_EQ(compare(tried, truth, LEVELS[2], 5e-4).answer, Answer::Differ);
}

// --------------------------------------------------------------------------------------------------------------- cases
TEST(Cases, AreTheSameAgain)
{
    for (uint64_t session = 0; session < 8; ++session) {
        const Case a = Session(3, session).draw(5), b = Session(3, session).draw(5);
        EXPECT_EQ(a.scene.positions, b.scene.positions);
        EXPECT_EQ(a.settings, b.settings);
        EXPECT_EQ(a.describe(), b.describe());
    }
}

TEST(Cases, HaveTheSettingsThatAreWanted)
{
    const Wanted wanted{.kind = "things", .truth = "pt", .settings = {{"method", "restir-pt"}, {"temporal", "on"}}};
    for (uint64_t index = 0; index < 20; ++index) {
        const Case c = Session(5, index, wanted).draw(index % SESSION_CASES);
        EXPECT_EQ(c.settings.method, passes::Method::RestirPt);
        EXPECT_TRUE(c.settings.temporal);
        EXPECT_GT(c.settings.frames, 1u);
    }
    EXPECT_THROW(Session(5, 0, {.settings = {{"shape", "round"}}}), Error);
}

// Scenes of a session need the same features, so that they share compiled stages.
TEST(Cases, OfASessionCompileOnce)
{
    for (uint64_t index = 0; index < 60; ++index) {
        const Session session(9, index);
        const auto featuresOf = [&](uint64_t place) {
            const Case c = session.draw(place);
            const bool moves = !c.moves.empty();
            const scene::SceneFeatures f =
                moves ? scene::MovingTables(withMotion(c.scene, c.moves), UINT64_MAX).last().features
                      : scene::makeSceneTables(c.scene, UINT64_MAX).features;
            return passes::makeVariant(f, passes::Settings{}, false, {}, moves);
        };
        const passes::Variant first = featuresOf(0);
        for (uint64_t place = 1; place < 4; ++place)
            for (const auto& [name, value] : passes::describe(featuresOf(place)))
                EXPECT_EQ(value, passes::describe(first).at(name)) << name << " " << session.draw(place).describe();
    }
}

TEST(Cases, OfAllKindsAndSettingsAreDrawn)
{
    std::map<std::string, size_t> seen;
    for (uint64_t index = 0; index < 400; ++index) {
        const Case c = Session(4, index).draw(index % SESSION_CASES);
        ++seen[KIND_NAMES[size_t(c.kind)]];
        ++seen[TRUTH_NAMES[size_t(c.truth)]];
        ++seen[c.orbit != 0 ? "moving" : "resting"];
        ++seen[c.scene.cameras[0].orthographic ? "orthographic" : "perspective"];
        for (const auto& [name, value] : passes::toText(c.settings)) ++seen[name + " " + value];
    }
    for (const char* name : KIND_NAMES) EXPECT_GT(seen[name], 5u) << name;
    for (const char* name : TRUTH_NAMES) EXPECT_GT(seen[name], 5u) << name;
    for (const char* name :
         {"moving", "resting", "orthographic", "perspective", "temporal on", "temporal off", "spatial 0"})
        EXPECT_GT(seen[name], 5u) << name;
    for (const passes::KnobText& knob : passes::describeSettings()) { // every word of every choice
        std::string word;
        for (const char c :
             knob.name == "average" || knob.values.find('|') == std::string::npos ? "" : knob.values + "|") {
            if (c != '|') {
                word += c;
                continue;
            }
            EXPECT_GT(seen[knob.name + " " + word], 5u) << knob.name << " " << word;
            word.clear();
        }
    }
}

// What is written is read as the same scene, but for what glTF moves: the box's center is the origin.
TEST(CaseFiles, HoldTheCase)
{
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "hunt_case_files";
    for (uint64_t index = 0; index < 40; ++index) {
        const Case c = Session(8, index).draw(1);
        if (c.scene.environment.height > scene::MAX_ENVIRONMENT_WIDTH) continue;
        writeCase(folder / "case", c, "nothing");
        const Case back = readCase(folder / "case.json");
        EXPECT_EQ(back.describe().substr(back.describe().find('(')).substr(0, 8),
                  c.describe().substr(c.describe().find('(')).substr(0, 8));
        passes::Settings settings = c.settings;
        EXPECT_EQ(back.settings, settings) << c.describe();
        EXPECT_EQ(back.orbit, c.orbit);
        EXPECT_EQ(back.scene.environment.radiance, c.scene.environment.radiance);
        ASSERT_EQ(back.scene.lights.size(), c.scene.lights.size());
        for (size_t i = 0; i < c.scene.lights.size(); ++i) {
            EXPECT_LT(glm::length(back.scene.lights[i].intensity - c.scene.lights[i].intensity),
                      1e-6f * glm::length(c.scene.lights[i].intensity));
            EXPECT_FLOAT_EQ(back.scene.lights[i].outerConeAngle, c.scene.lights[i].outerConeAngle);
        }
        // Materials by what the triangles show.
        size_t areas = 0;
        double size = 0;
        for (const glm::vec3& p : c.scene.positions) size = std::max(size, double(glm::length(p)));
        using Shown = std::pair<scene::Material, glm::vec3>; // and where its triangle begins
        std::vector<Shown> expected, found;
        const auto list = [&](const scene::Scene& of, std::vector<Shown>& shown) {
            for (const scene::Triangle& t : of.triangles) {
                const auto corner = [&](size_t i) { return of.positions[t.vertices[i]]; };
                const glm::vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
                if (normal != glm::vec3(0))
                    shown.emplace_back(of.materials[t.material], corner(0) + glm::vec3(of.origin)), ++areas;
            }
        };
        list(c.scene, expected);
        list(back.scene, found);
        ASSERT_EQ(found.size(), expected.size()) << c.describe();
        for (const Shown& one : expected) {
            const scene::Material& material = one.first;
            const auto same = [&](const Shown& other) {
                const scene::Material& m = other.first;
                return double(glm::length(other.second - one.second)) < 1e-6 * size &&
                       m.baseColor == material.baseColor && m.roughness == material.roughness &&
                       m.metallic == material.metallic && m.specular == material.specular &&
                       m.specularColor == material.specularColor && m.ior == material.ior &&
                       m.transmission == material.transmission && m.thin == material.thin &&
                       m.alpha == material.alpha && m.unlit == material.unlit &&
                       m.doubleSided == material.doubleSided &&
                       glm::length(m.emission - material.emission) <= 1e-6f * glm::length(material.emission) &&
                       (m.baseColorTexture.image == scene::NONE) == (material.baseColorTexture.image == scene::NONE) &&
                       glm::length(m.baseColorTexture.row0 - material.baseColorTexture.row0) < 1e-5f &&
                       glm::length(m.baseColorTexture.row1 - material.baseColorTexture.row1) < 1e-5f;
            };
            EXPECT_TRUE(std::ranges::any_of(found, same)) << c.describe();
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(Shrinking, LeavesWhatFails)
{
    const Case c = Session(2, 4, {.kind = "things"}).draw(3);
    ASSERT_GT(c.scene.triangles.size(), 4u);
    const glm::vec3 guilty = c.scene.positions[c.scene.triangles[2].vertices[0]];
    const auto fails = [&](const Case& smaller) {
        return std::ranges::any_of(smaller.scene.triangles, [&](const scene::Triangle& t) {
            return smaller.scene.positions[t.vertices[0]] == guilty;
        });
    };
    const Case small = shrink(c, fails, [] { return false; });
    EXPECT_TRUE(fails(small));
    EXPECT_EQ(small.scene.triangles.size(), 1u);
    EXPECT_EQ(small.scene.lights.size(), 0u);
    EXPECT_EQ(small.settings.maxBounces, 0u);
    EXPECT_EQ(small.orbit, 0);
}

// ------------------------------------------------------------------------------------------------------------- on the
// GPU
class Hunter : public RendererFixture
{
  protected:
    static Finding tried(gpu::Device& on, const Case& c, uint64_t seed = 1, const Effort& effort = {})
    {
        return examine(on, std::make_shared<passes::PipelinePool>(on), c, seed, effort);
    }

    // A picture that every error of resampling disturbs.
    static Case hard()
    {
        Case c{.kind = Kind::Things, .truth = Truth::PathTracer};
        Draw draw{1, 2};
        c.scene = drawScene(Kind::Things, Truth::PathTracer, Palette{.emitters = true}, draw);
        c.settings.method = passes::Method::RgbRestir;
        c.settings.width = c.settings.height = 8;
        c.settings.maxBounces = 2;
        c.settings.frames = 4;
        c.settings.average = false;
        c.orbit = 1;
        return c;
    }
};

TEST_F(Hunter, FindsNothingInAFixedHunt)
{
    for (uint64_t index = 0; index < KINDS; ++index) {
        const Case c = Session(2026, index, {.kind = KIND_NAMES[index]}).draw(0);
        const Finding finding =
            examine(device(), std::make_shared<passes::PipelinePool>(device()), c, c.number, {.repeats = true});
        EXPECT_FALSE(finding.found()) << c.describe() << "\n" << finding.describe();
    }
}

TEST_F(Hunter, FindsWhatIsPlanted)
{
    ASSERT_FALSE(tried(device(), hard()).found());
    support::PlantedShaders shaders("hunter");
    shaders.plant(support::plantedError("WeightTimes1_02"));
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const Finding finding = tried(planted, hard());
    EXPECT_EQ(finding.fault, Fault::Different) << finding.describe();
}

// As the program was before it knew of two worlds.
TEST_F(Hunter, FindsWhatIsPlantedWhereThingsMove)
{
    Case c = hard();
    c.settings.method = passes::Method::RestirPt; // little to compile
    c.settings.shift = passes::Shift::Replay;
    c.settings.spatial = 0;
    c.settings.maxBounces = 1;
    const auto lamp = std::ranges::find_if(c.scene.materials, [](const auto& m) { return m.emission != glm::vec3(0); });
    ASSERT_NE(lamp, c.scene.materials.end());
    Move dims{.what = Move::What::Paint, .target = uint32_t(lamp - c.scene.materials.begin())};
    dims.emission = 0.1f * lamp->emission;
    c.moves = {dims};
    ASSERT_FALSE(tried(device(), c).found());
    support::PlantedShaders shaders("hunter_moves");
    shaders.plant(support::plantedError("PreviousWorldForgotten"));
    gpu::Device planted = openDevice({.shaderDirectory = shaders.folder().string()});
    const Finding finding = tried(planted, c);
    EXPECT_EQ(finding.fault, Fault::Different) << finding.describe();
}

TEST_F(Hunter, FindsLightInTheDark)
{
    Case c{.kind = Kind::Sealed, .truth = Truth::Black};
    scene::addSphere(c.scene, scene::addMaterial(c.scene, scene::diffuse("wall", glm::vec3(0.5))), glm::vec3(0), 1, 0);
    c.scene.environment = {1, 1, {glm::vec3(1)}};
    c.scene.cameras.push_back(scene::lookAt("inside", {0.1, 0.05, 0}, {0, 0, -1}, 60));
    c.settings.width = c.settings.height = 8;
    EXPECT_EQ(tried(device(), c).fault, Fault::None);
    c.scene.triangles.pop_back(); // a hole
    EXPECT_EQ(tried(device(), c).fault, Fault::Light);
}

TEST_F(Hunter, FindsWhatAnotherTruthSays)
{
    Case c = hard();
    c.settings.method = passes::Method::Pt;
    c.truth = Truth::Reference;
    EXPECT_EQ(tried(device(), c).fault, Fault::None);
}

// What hunts have found, mended since.
std::vector<std::string> corpus()
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(TRICHROME_SOURCE_DIR "/tests/hunt/corpus"))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

class Corpus : public Hunter, public testing::WithParamInterface<std::string>
{
};
TEST_P(Corpus, IsMended)
{
    const Case c = readCase(TRICHROME_SOURCE_DIR "/tests/hunt/corpus/" + GetParam() + ".json");
    const Finding finding = tried(device(), c);
    EXPECT_FALSE(finding.found()) << c.describe() << "\n" << finding.describe();
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Corpus);
INSTANTIATE_TEST_SUITE_P(Of, Corpus, testing::ValuesIn(corpus()), [](const auto& i) {
    std::string name = i.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

} // namespace
} // namespace hunt
