#include "passes/estimator.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "shaders/shared/frame.h"

#include <algorithm>
#include <cmath>

namespace passes
{

const std::vector<Estimator>& estimators()
{
    constexpr glm::vec3 LUMINANCE(0.2126f, 0.7152f, 0.0722f); // Rec. 709
    constexpr glm::vec3 RED(1, 0, 0), GREEN(0, 1, 0), BLUE(0, 0, 1), ALL(1, 1, 1);
    // In the order of Method, after Pt.
    static const std::vector<Estimator> list = {
        {.name = "restir-pt", .target = {LUMINANCE}, .resolve = {ALL}},
        {.name = "rgb-restir", .target = {RED, GREEN, BLUE}, .resolve = {RED, GREEN, BLUE}},
        {.name = "grouped-restir", .target = {RED + GREEN, BLUE}, .resolve = {RED + GREEN, BLUE}},
    };
    return list;
}

const Estimator& estimatorOf(Method method)
{
    CHECK(method != Method::Pt);
    const Estimator& estimator = estimators().at(static_cast<size_t>(method) - 1);
    checkUnbiased(estimator);
    return estimator;
}

bool oneHot(const Estimator& estimator)
{
    return std::ranges::all_of(estimator.target, [](const glm::vec3& target) {
        return (target.r != 0) + (target.g != 0) + (target.b != 0) == 1;
    });
}

Color colorReading(const Settings& settings)
{
    if (settings.method == Method::Pt || oneHot(estimatorOf(settings.method))) return Color::Chosen;
    return settings.color;
}

void checkUnbiased(const Estimator& estimator)
{
    const size_t count = estimator.target.size();
    if (count == 0 || count > shared::MAX_RESERVOIRS || estimator.resolve.size() != count)
        throw Error("Estimator \"{}\" has {} targets and {} resolve weights; it takes as many of both, 1 to {}.",
                    estimator.name, count, estimator.resolve.size(), shared::MAX_RESERVOIRS);
    for (int channel = 0; channel < 3; ++channel) {
        const char name = "RGB"[channel];
        float sum = 0;
        for (size_t c = 0; c < count; ++c) {
            const float target = estimator.target[c][channel];
            const float resolve = estimator.resolve[c][channel];
            if (!(target >= 0 && resolve >= 0 && std::isfinite(target) && std::isfinite(resolve)))
                throw Error("Estimator \"{}\" has a weight below 0 or not finite (target {}, resolve {}) in reservoir "
                            "{}, channel {}.",
                            estimator.name, target, resolve, c, name);
            if (resolve > 0 && target == 0)
                throw Error(
                    "Estimator \"{}\" is biased: reservoir {} resolves channel {}, which its target leaves out.",
                    estimator.name, c, name);
            sum += resolve;
        }
        if (std::abs(sum - 1) > 1e-6f)
            throw Error("Estimator \"{}\" is biased: the resolve weights of channel {} sum to {}, not 1.",
                        estimator.name, name, sum);
    }
}

} // namespace passes
