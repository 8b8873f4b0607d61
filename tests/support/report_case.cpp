#include "tests/support/report_case.h"

#include "tests/support/shared_files.h"

#include <algorithm>
#include <cmath>
#include <sstream>

using Json = nlohmann::json;

namespace
{

// `right` is a number, a truth value, null, a text ("", or "above 0.95 (why)", "below 0.2"), or a list of such.
bool holds(const Json& right, const Json& tolerance, const Json& measured)
{
    if (right.is_array()) {
        if (measured.size() != right.size()) return false;
        for (size_t i = 0; i < right.size(); ++i)
            if (!holds(right[i], tolerance, measured[i])) return false;
        return true;
    }
    if (right.is_string() && !right.get<std::string>().empty()) {
        std::istringstream words(right.get<std::string>());
        std::string relation;
        double limit = 0;
        if (!(words >> relation >> limit) || !measured.is_number()) return false;
        return relation == "above" ? measured > limit : relation == "below" && measured < limit;
    }
    if (right.is_number() && measured.is_number())
        return std::abs(measured.get<double>() - right.get<double>()) <=
               (tolerance.is_number() ? double(tolerance) : 0);
    return right == measured;
}

std::string sentence(const Json& check, const Json& measured)
{
    return check["what"].get<std::string>() + ": measured " + measured.dump() + ", right is " + check["right"].dump() +
           ", tolerance " + check["tolerance"].dump();
}

} // namespace

void ReportCase::SetUp()
{
    SKIP_WITHOUT_SHARED("reports/manifest.json");
    Trichrome::SetUp();
}

void ReportCase::TearDown()
{
    if (IsSkipped()) return;
    for (const Json& check : case_.at("checks")) EXPECT_TRUE(done_.contains(check["what"])) << "not checked: " << check;
}

void ReportCase::open(const std::string& name)
{
    folder_ = std::filesystem::absolute(sharedPath("reports"));
    const Json manifest = readJson(folder_ / "manifest.json");
    for (const Json& one : manifest["cases"])
        if (one["name"] == name) case_ = one;
    ASSERT_FALSE(case_.is_null()) << "no situation " << name;
}

Outcome ReportCase::runCommand(size_t index, const std::vector<std::string>& more) const
{
    std::istringstream line(case_.at("commands").at(index).get<std::string>());
    std::vector<std::string> words;
    for (std::string word; line >> word;) {
        if (word.starts_with("OUT/")) word = directory / word.substr(4);
        if (std::ranges::find(case_["files"], Json(word)) != case_["files"].end()) word = path(word);
        words.push_back(word);
    }
    words.erase(words.begin()); // trichrome
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
}

ReportCase::Rendered ReportCase::render(size_t index, Warns warns) const
{
    SCOPED_TRACE(case_["commands"][index]);
    const Outcome outcome = runCommand(index);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err.starts_with("Warning: "), warns == Warns::Yes) << outcome.err;
    if (outcome.exitCode != 0) return {};
    Rendered rendered{image::read(directory / "out.exr").image, outcome.err, readJson(directory / "out.json")};
    for (const auto& [stage, count] : rendered.stats["nonfinite"].items()) EXPECT_EQ(count, 0) << stage;
    return rendered;
}

std::vector<Json> ReportCase::checksOf(const std::string& what)
{
    done_.insert(what);
    std::vector<Json> checks;
    for (const Json& check : case_.at("checks"))
        if (check["what"] == what) checks.push_back(check);
    EXPECT_FALSE(checks.empty()) << "no check \"" << what << "\"";
    return checks;
}

void ReportCase::expect(const std::string& what, const Json& measured)
{
    for (const Json& check : checksOf(what))
        EXPECT_TRUE(holds(check["right"], check["tolerance"], measured)) << sentence(check, measured);
}

void ReportCase::expectNotYet(const std::string& what, const Json& measured)
{
    for (const Json& check : checksOf(what))
        EXPECT_FALSE(holds(check["right"], check["tolerance"], measured))
            << "It holds now, so expect() it instead of expectNotYet(). " << sentence(check, measured);
}

glm::dvec3 meanOf(const image::Image& picture)
{
    glm::dvec3 sum(0);
    for (const glm::vec3& pixel : picture.pixels) sum += glm::dvec3(pixel);
    return sum / double(picture.pixels.size());
}

float largestOf(const image::Image& picture)
{
    float largest = 0;
    for (const glm::vec3& p : picture.pixels) largest = std::max({largest, p.r, p.g, p.b});
    return largest;
}

double shareOf(const image::Image& picture, const std::function<bool(uint32_t x, uint32_t y)>& property)
{
    double count = 0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) count += property(x, y);
    return count / double(picture.pixels.size());
}
