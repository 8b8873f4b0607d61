#pragma once
// Situations that people reported of other renderers, rebuilt small (../shared/reports/manifest.json): each with the
// commands that show it, and the values that must come out. A test runs the commands, measures, and says which check of
// the manifest each value is for; a check that is left out is a failure.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

class ReportCase : public Trichrome
{
  protected:
    // What a command that renders leaves behind.
    struct Rendered {
        image::Image picture;
        std::string err;
        nlohmann::json stats;
    };

    void SetUp() override; // skips without ../shared
    void TearDown() override;

    // To be called first: the situation by its name.
    void open(const std::string& name);
    size_t commandCount() const { return case_.at("commands").size(); }
    std::string path(const std::string& file) const { return (folder_ / file).string(); } // of the situation's

    Outcome runCommand(size_t index, const std::vector<std::string>& more = {}) const;
    // Expects exit code 0, no value that is not finite, and warnings only where they are due.
    enum class Warns { No, Yes };
    Rendered render(size_t index, Warns warns = Warns::No) const;

    // Expects `right` of the check, within its tolerance; of all checks of that name.
    void expect(const std::string& what, const nlohmann::json& measured);
    // What the program cannot do yet. Fails as soon as it can: then expect() has to take its place.
    void expectNotYet(const std::string& what, const nlohmann::json& measured);

  private:
    std::vector<nlohmann::json> checksOf(const std::string& what);

    std::filesystem::path folder_;
    nlohmann::json case_;
    std::set<std::string> done_;
};

glm::dvec3 meanOf(const image::Image& picture);
float largestOf(const image::Image& picture);
double shareOf(const image::Image& picture, const std::function<bool(uint32_t x, uint32_t y)>& property);
