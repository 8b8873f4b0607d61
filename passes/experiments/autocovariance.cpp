#include "passes/experiments/autocovariance.h"

#include "engine/base/check.h"
#include "passes/estimator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace passes
{

namespace
{

std::span<const float> channels(const std::vector<glm::vec3>& pixels)
{
    return {&pixels.front().x, 3 * pixels.size()};
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

// Is this frame one of those that the next point M = 2, 4, 8, ... is compared with?
bool isAwaited(uint32_t frame)
{
    const uint32_t lag = std::bit_ceil(frame + 1) - frame;
    return std::has_single_bit(lag) && (lag == 1 || lag <= std::min(MAX_LAG, (frame + lag) / 2));
}

// For the path tracer, each channel itself.
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

// What fp32 cannot tell from the emission in emission + light is no light.
constexpr double RESOLUTION = 4 * 5.96e-8;

} // namespace

Chain::Chain(Renderer& renderer, Sequence sequence) : renderer_(renderer), sequence_(std::move(sequence))
{
    renderer_.reset();
}

void Chain::step()
{
    ++frame_;
    sequence_.bring(renderer_, int64_t(frame_) - 1);
    renderer_.renderFrame();
    if (sequence_.moves() && !held_.empty()) follow();
    if (frame_ > 1 && std::has_single_bit(frame_)) take();
    if (!isAwaited(frame_)) return;
    Held held{.frame = frame_, .picture = renderer_.read(LAST_FRAME), .pixels = {}};
    held.pixels.resize(held.picture.pixels.size() / renderer_.runs());
    std::iota(held.pixels.begin(), held.pixels.end(), 0u);
    held_.push_back(std::move(held));
}

void Chain::follow()
{
    const std::vector<uint32_t> previous = renderer_.readPreviousPixels();
    for (Held& held : held_) {
        const std::vector<uint32_t> before = held.pixels;
        for (size_t i = 0; i < previous.size(); ++i)
            held.pixels[i] = previous[i] == shared::NO_NEIGHBOR ? previous[i] : before[previous[i]];
    }
}

void Chain::take()
{
    const uint32_t runs = renderer_.runs();
    const image::Image now = renderer_.read(LAST_FRAME);
    ChainPoint point{.frame = frame_};
    for (const Held& held : std::exchange(held_, {})) { // the last one is the frame before
        std::vector<uint32_t> there, here;
        for (uint32_t pixel = 0; pixel < held.pixels.size(); ++pixel) {
            if (held.pixels[pixel] == shared::NO_NEIGHBOR) continue;
            there.push_back(held.pixels[pixel]);
            here.push_back(pixel);
        }
        if (here.empty()) continue;
        const std::vector<glm::vec3> x = gather(held.picture, there, runs), y = gather(now, here, runs);
        const statistics::BatchValue autocovariance = statistics::meanCovariance(channels(x), channels(y), runs);
        if (const uint32_t lag = frame_ - held.frame; lag > 1) {
            point.lags.insert(point.lags.begin(), {lag, autocovariance});
        } else {
            point.pixels = here.size();
            point.autocovariance = autocovariance;
            point.variance = statistics::meanCovariance(channels(y), channels(y), runs);
        }
    }
    if (point.pixels == 0) return;
    if (!sequence_.moves()) {
        const image::Image film = renderer_.read(MEAN);
        point.film = statistics::meanCovariance(channels(film.pixels), channels(film.pixels), runs);
    }
    points_.push_back(std::move(point));
}

void LawMeter::Sums::add(double c, double s, double n)
{
    const double d = c - color;
    color += d / n;
    square += d * (c - color);
    weight += (s - weight) / n;
    ratio += ((s != 0 ? c * c / s : 0) - ratio) / n;
}

// Unbiased: n / (n - 1) takes what the means' own noise adds to s q - C^2.
double LawMeter::Sums::plateau(double n) const
{
    return n / (n - 1) * (weight * ratio - color * color);
}

LawMeter::LawMeter(Renderer& renderer, image::Image emission)
    : renderer_(renderer), runs_(renderer.runs()), targets_(resolvingTargets(renderer.settings().method)),
      emission_(std::move(emission)), sums_(3 * runs_ * emission_.pixels.size())
{
    renderer_.reset();
}

void LawMeter::step()
{
    const size_t pixels = emission_.pixels.size();
    renderer_.renderFrame();
    const image::Image frame = renderer_.read(LAST_FRAME);
    CHECK_EQ(frame.pixels.size(), runs_ * pixels);
    ++frames_;
    for (size_t i = 0; i < frame.pixels.size(); ++i) {
        const glm::dvec3 direct(emission_.pixels[i % pixels]);
        glm::dvec3 color = glm::dvec3(frame.pixels[i]) - direct;
        for (int c = 0; c < 3; ++c)
            if (std::abs(color[c]) <= RESOLUTION * direct[c]) color[c] = 0;
        for (int c = 0; c < 3; ++c)
            sums_[3 * i + size_t(c)].add(color[c], glm::dot(glm::dvec3(targets_[size_t(c)]), color), frames_);
    }
}

FrameLaw LawMeter::law() const
{
    CHECK_LE(2u, frames_);
    const size_t pixels = emission_.pixels.size();
    FrameLaw law{.floor = std::vector<glm::dvec3>(pixels), .mean = std::vector<glm::dvec3>(pixels)};
    if (runs_ > 2) {
        law.variance.without.resize(runs_);
        law.plateau.without.resize(runs_);
    }
    const double share = 1 / double(3 * pixels), r = double(runs_);
    for (size_t k = 0; k < 3 * pixels; ++k) { // a channel of a pixel, all frames of all runs pooled
        const auto of = [&](size_t run) -> const Sums& { return sums_[3 * run * pixels + k]; };
        Sums all;
        for (size_t run = 0; run < runs_; ++run) {
            all.color += of(run).color / r;
            all.weight += of(run).weight / r;
            all.ratio += of(run).ratio / r;
        }
        for (size_t run = 0; run < runs_; ++run) {
            const double d = of(run).color - all.color;
            all.square += of(run).square + frames_ * d * d;
        }
        const double floor = all.plateau(r * frames_);
        law.floor[k / 3][int(k % 3)] = floor;
        law.mean[k / 3][int(k % 3)] = all.color;
        law.variance.value += share * all.square / (r * frames_ - 1);
        law.plateau.value += share * floor;
        for (size_t run = 0; run < law.plateau.without.size(); ++run) {
            const Sums& one = of(run);
            const double d = one.color - all.color, n = (r - 1) * frames_;
            const Sums rest = {.color = (r * all.color - one.color) / (r - 1),
                               .weight = (r * all.weight - one.weight) / (r - 1),
                               .ratio = (r * all.ratio - one.ratio) / (r - 1),
                               .square = all.square - one.square - frames_ * r / (r - 1) * d * d};
            law.variance.without[run] += share * rest.square / (n - 1);
            law.plateau.without[run] += share * rest.plateau(n);
        }
    }
    return law;
}

Settings lawSettings(Settings settings)
{
    settings.temporal = false;
    settings.spatial = 0;
    settings.color = Color::Chosen;
    return settings;
}

Settings emissionSettings(Settings settings)
{
    settings.method = Method::Pt;
    settings.maxBounces = 0;
    return settings;
}

bool lawHolds(const Settings& settings, bool sameView)
{
    const bool own = colorReading(settings) == Color::Variate && settings.colorConfidence < settings.maxConfidence;
    const bool mutated = settings.mutate != Mutate::Off && !accumulates(settings); // the law knows frozen samples
    return settings.temporal && settings.spatial == 0 && sameView && !own && !mutated;
}

bool accumulates(const Settings& settings)
{
    return resolvingTargets(settings.method) == resolvingTargets(Method::Pt) ||
           colorReading(settings) == Color::Variate;
}

// Frame M shows c_M = S chi(Y_M), or A_M = c / M + (1 - 1 / M) c_(M-1), c the single frame M alone: the mean of c_M
// over which of the two was chosen. So frames n and M covary by n / M Var c_n, or by n / M Var A_n, with
// Var c_n = V / n + (1 - 1 / n) P and Var A_n = V / n^2 + (1 - 1 / n)^2 Var c_(n-1).
statistics::BatchValue predictedAutocovariance(const FrameLaw& law, Color color, double frame, double lag)
{
    const double n = frame - lag, kept = color == Color::Chosen ? 1 : 1 - 2 / std::max(n, 2.0);
    return statistics::combination(1 / frame, law.variance, (n - 1) / frame * kept, law.plateau);
}

// The mean of what frames covary by, over all pairs of frames.
statistics::BatchValue predictedFilm(const FrameLaw& law, uint32_t frame)
{
    double variance = 0, plateau = 0;
    for (double later = 1; later <= frame; ++later) { // with itself, and twice with all before
        variance += (2 * later - 1) / later;
        plateau += (later - 1) * (later - 1) / later;
    }
    const double pairs = double(frame) * double(frame);
    return statistics::combination(variance / pairs, law.variance, plateau / pairs, law.plateau);
}

} // namespace passes
