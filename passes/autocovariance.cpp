#include "passes/autocovariance.h"

#include "engine/base/check.h"
#include "passes/estimator.h"

#include <cmath>

namespace passes
{

namespace
{

std::span<const float> channels(const std::vector<glm::vec3>& pixels)
{
    return {&pixels.front().x, 3 * pixels.size()};
}

bool isPowerOfTwo(uint32_t n)
{
    return (n & (n - 1)) == 0;
}

// By run, the pixels of `list` (pairs) from pictures of all runs.
std::vector<glm::vec3> gather(const image::Image& picture, const std::vector<uint32_t>& list, uint32_t runs)
{
    const size_t pixels = picture.pixels.size() / runs;
    std::vector<glm::vec3> result;
    result.reserve(list.size() * runs);
    for (size_t run = 0; run < runs; ++run)
        for (const uint32_t pixel : list) result.push_back(picture.pixels[run * pixels + pixel]);
    return result;
}

ChainPoint pointOf(uint32_t frame, const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& now,
                   uint32_t runs)
{
    return {.frame = frame,
            .pixels = now.size() / runs,
            .autocovariance = statistics::meanCovariance(channels(before), channels(now), runs),
            .variance = statistics::meanCovariance(channels(now), channels(now), runs)};
}

// Of one channel of one pixel in one run. C: the color; s: the weight sum that it is drawn with; E[C^2 / s] is E[q],
// with q the mean of f_c^2 / p_hat over a tree's paths: C^2 / s has that mean given the tree.
struct Sums {
    double color = 0, weight = 0, ratio = 0; // running means
    double square = 0;                       // sum of squared deviations of C

    void add(double c, double s, double n)
    {
        const double d = c - color;
        color += d / n;
        square += d * (c - color);
        weight += (s - weight) / n;
        ratio += ((s != 0 ? c * c / s : 0) - ratio) / n;
    }
};

// P from the means of n values. Unbiased: n / (n - 1) takes what the means' own noise adds to s q - C^2.
double plateauOf(const Sums& sums, double n)
{
    return n / (n - 1) * (sums.weight * sums.ratio - sums.color * sums.color);
}

// What fp32 cannot tell from the emission in emission + light is no light.
constexpr double RESOLUTION = 4 * 5.96e-8;

} // namespace

std::vector<ChainPoint> measureChain(Renderer& renderer, uint32_t lastFrame, const CameraAt& cameraAt, const Tick& tick)
{
    const uint32_t runs = renderer.runs();
    std::vector<ChainPoint> points;
    image::Image before;
    renderer.reset();
    for (uint32_t frame = 1; frame <= lastFrame; ++frame) {
        if (cameraAt) renderer.setCamera(cameraAt(frame - 1));
        renderer.renderFrame();
        if (isPowerOfTwo(frame + 1)) before = renderer.readFrame();
        if (frame > 1 && isPowerOfTwo(frame)) {
            const image::Image now = renderer.readFrame();
            if (cameraAt) {
                std::vector<uint32_t> there, here;
                const std::vector<uint32_t> previous = renderer.readPreviousPixels();
                for (uint32_t pixel = 0; pixel < previous.size(); ++pixel) {
                    if (previous[pixel] == shared::NO_NEIGHBOR) continue;
                    there.push_back(previous[pixel]);
                    here.push_back(pixel);
                }
                if (!here.empty())
                    points.push_back(pointOf(frame, gather(before, there, runs), gather(now, here, runs), runs));
            } else {
                points.push_back(pointOf(frame, before.pixels, now.pixels, runs));
            }
        }
        if (tick && !tick()) break;
    }
    return points;
}

std::optional<FrameLaw> measureLaw(Renderer& renderer, uint32_t frames, const std::array<glm::vec3, 3>& targets,
                                   const image::Image& emission, const Tick& tick)
{
    CHECK_LE(2u, frames);
    CHECK_LE(3u, renderer.runs());
    const size_t runs = renderer.runs(), pixels = emission.pixels.size();
    std::vector<Sums> sums(3 * runs * pixels);
    renderer.reset();
    for (uint32_t frame = 1; frame <= frames; ++frame) {
        renderer.renderFrame();
        const image::Image picture = renderer.readFrame();
        CHECK_EQ(picture.pixels.size(), runs * pixels);
        for (size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::dvec3 direct(emission.pixels[i % pixels]);
            glm::dvec3 color = glm::dvec3(picture.pixels[i]) - direct;
            for (int c = 0; c < 3; ++c)
                if (std::abs(color[c]) <= RESOLUTION * direct[c]) color[c] = 0;
            for (int c = 0; c < 3; ++c)
                sums[3 * i + size_t(c)].add(color[c], glm::dot(glm::dvec3(targets[size_t(c)]), color), frame);
        }
        if (tick && !tick()) return std::nullopt;
    }

    FrameLaw law{.floor = std::vector<glm::dvec3>(pixels), .mean = std::vector<glm::dvec3>(pixels)};
    law.variance.without.resize(runs);
    law.plateau.without.resize(runs);
    const double share = 1 / double(3 * pixels), r = double(runs);
    for (size_t k = 0; k < 3 * pixels; ++k) { // a channel of a pixel, all frames of all runs pooled
        const auto of = [&](size_t run) -> const Sums& { return sums[3 * run * pixels + k]; };
        Sums all;
        for (size_t run = 0; run < runs; ++run) {
            all.color += of(run).color / r;
            all.weight += of(run).weight / r;
            all.ratio += of(run).ratio / r;
        }
        for (size_t run = 0; run < runs; ++run) {
            const double d = of(run).color - all.color;
            all.square += of(run).square + frames * d * d;
        }
        const double floor = plateauOf(all, r * frames);
        law.floor[k / 3][int(k % 3)] = floor;
        law.mean[k / 3][int(k % 3)] = all.color;
        law.variance.value += share * all.square / (r * frames - 1);
        law.plateau.value += share * floor;
        for (size_t run = 0; run < runs; ++run) {
            const Sums& one = of(run);
            const double d = one.color - all.color, n = (r - 1) * frames;
            const Sums rest = {.color = (r * all.color - one.color) / (r - 1),
                               .weight = (r * all.weight - one.weight) / (r - 1),
                               .ratio = (r * all.ratio - one.ratio) / (r - 1),
                               .square = all.square - one.square - frames * r / (r - 1) * d * d};
            law.variance.without[run] += share * rest.square / (n - 1);
            law.plateau.without[run] += share * plateauOf(rest, n);
        }
    }
    return law;
}

std::array<glm::vec3, 3> resolvingTargets(Method method)
{
    std::array<glm::vec3, 3> targets = {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
    if (method == Method::Pt) return targets;
    const Estimator& estimator = estimatorOf(method);
    for (int c = 0; c < 3; ++c)
        for (size_t r = 0; r < estimator.target.size(); ++r) {
            if (estimator.resolve[r][c] == 0) continue;
            CHECK_EQ(estimator.resolve[r][c], 1.0f); // one reservoir a channel: the law knows no mixtures
            targets[size_t(c)] = estimator.target[r];
        }
    return targets;
}

bool accumulates(Method method)
{
    return resolvingTargets(method) == resolvingTargets(Method::Pt);
}

statistics::BatchValue predictedAutocovariance(const FrameLaw& law, double frame)
{
    return statistics::combination(1 / frame, law.variance, 1 - 2 / frame, law.plateau);
}

} // namespace passes
