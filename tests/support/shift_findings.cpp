#include "tests/support/shift_findings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shaders/shared/frame.h"
#include "shaders/shared/streams.h"
#include "tests/support/lobe_numbers.h"

namespace support
{

void Tally::add(double error)
{
    errors.push_back(std::isnan(error) ? std::numeric_limits<double>::infinity() : error);
}

size_t Tally::wrong() const
{
    return size_t(std::ranges::count_if(errors, [](double error) { return !(error <= TOLERANCE); }));
}

double Tally::quantile(double share) const
{
    std::vector<double> sorted = errors;
    std::ranges::sort(sorted);
    return sorted.empty() ? 0 : sorted[size_t(share * double(sorted.size() - 1))];
}

namespace
{

using glm::dvec2, glm::dvec3;
using passes::Shift;
using shared::OfferedPath, shared::Scattering, shared::ShiftedPath, shared::Tree;

double relative(const dvec3& value, const dvec3& expected)
{
    return glm::length(value - expected) / glm::length(expected);
}

bool isDone(const ShiftedPath& shifted)
{
    return shifted.f.w == float(shared::SHIFT_DONE);
}

dvec3 measured(const OfferedPath& path) // f(Y)
{
    return dvec3(path.f) * double{path.density};
}

// x_r is the light.
bool joinsLight(const OfferedPath& path)
{
    return path.reconnectionIndex == (path.pathId >> 1) + 1;
}

// x_r scatters on in a direction that was drawn, not towards a sampled light.
bool departs(const OfferedPath& path)
{
    return !joinsLight(path) && !(path.reconnectionIndex == (path.pathId >> 1) && (path.pathId & 1) == 0);
}

// Around the direction from x_(r-1) to x_r: by x_r's barycentrics, or by the direction itself where that is the sky.
Patch arrivals(const OfferedPath& path, const ShiftedPath& in)
{
    const dvec3 direction(path.direction), from(in.before.position);
    if (path.triangle == shared::NO_INDEX) {
        const dvec3 side = glm::normalize(glm::cross(direction, dvec3(0.3, 0.5, 0.8)));
        return
            [=](const dvec2& q) { return glm::normalize(direction + q.x * side + q.y * glm::cross(direction, side)); };
    }
    const dvec3 a(in.corners[0]), b(in.corners[1]), c(in.corners[2]);
    const dvec2 at(path.barycentric);
    return [=](const dvec2& q) { return glm::normalize(a + (at.x + q.x) * (b - a) + (at.y + q.y) * (c - a) - from); };
}

Patch departures(const OfferedPath& path)
{
    const dvec3 direction(path.direction);
    const dvec3 side = glm::normalize(glm::cross(direction, dvec3(0.3, 0.5, 0.8)));
    return [=](const dvec2& q) { return glm::normalize(direction + q.x * side + q.y * glm::cross(direction, side)); };
}

// How much of primary sample space draws paths around this one in a domain, over coordinates that shifts preserve.
double densityIn(const OfferedPath& path, const ShiftedPath& in)
{
    return densityOver(in.before, arrivals(path, in)) * (departs(path) ? densityOver(in.at, departures(path)) : 1);
}

glm::uvec4 replacement(uint32_t k, const dvec3& numbers)
{
    glm::uvec4 words(0, 0, 0, shared::STREAM_PATH + 2 * k + shared::PURPOSE_SCATTER);
    for (int i = 0; i < 3; ++i) // 24 bits are used
        words[i] = uint32_t(std::clamp(std::floor(numbers[i] * 16777216 + 0.5), 0.0, 16777215.0)) << 8;
    return words;
}

// The tree that holds the shifted path in domain `to`; false where no random numbers draw it.
bool treeOf(const OfferedPath& path, const ShiftedPath& in, uint32_t to, Tree& tree)
{
    tree = {.pixel = to, .seedFrame = path.seedFrame, .seedPixel = path.seedPixel};
    if (path.reconnectionIndex == 0) return true;
    if (in.before.position.w == 0) return false;
    const auto arrival = numbersOf(in.before, arrivals(path, in)(dvec2(0)));
    if (!arrival) return false;
    tree.replaced[0] = replacement(path.reconnectionIndex - 1, *arrival);
    if (!departs(path)) return true;
    const auto departure = numbersOf(in.at, dvec3(path.direction));
    if (departure) tree.replaced[1] = replacement(path.reconnectionIndex, *departure);
    return departure.has_value();
}

bool isSamePath(const OfferedPath& a, const OfferedPath& b)
{
    return a.pathId == b.pathId && a.reconnectionIndex == b.reconnectionIndex && a.triangle == b.triangle;
}

std::string kindOf(const Scattering& at, const dvec3& direction)
{
    if (glm::dot(dvec3(at.normal), direction) < 0) return "through";
    return at.pick.y > 0 ? "glossy" : "diffuse";
}

std::string kindOf(const OfferedPath& path, const ShiftedPath& in)
{
    if (path.reconnectionIndex == 0) return "replayed";
    const std::string before = kindOf(in.before, arrivals(path, in)(dvec2(0)));
    return before + (joinsLight(path) ? " to light" : " to " + kindOf(in.at, dvec3(path.direction)));
}

} // namespace

ShiftFindings findingsOf(ShiftLab& lab, Shift shift, uint32_t treesPerPixel)
{
    constexpr const char* ENDINGS[] = {"dirac sampled", "lamp sampled", "sky sampled", "lamp met", "sky met"};
    std::vector<Tree> trees;
    for (uint32_t frame = 0; frame < treesPerPixel; ++frame)
        for (uint32_t pixel = 0; pixel < ShiftLab::SIZE * ShiftLab::SIZE; ++pixel)
            if (lab.sees(pixel)) trees.push_back({.pixel = pixel, .seedFrame = frame, .seedPixel = pixel});

    std::mt19937 random(1);
    const auto nearby = [&](uint32_t pixel) {
        for (;;) {
            const int x = int(pixel % ShiftLab::SIZE) + int(random() % 7) - 3;
            const int y = int(pixel / ShiftLab::SIZE) + int(random() % 7) - 3;
            if (x < 0 || y < 0 || x >= int(ShiftLab::SIZE) || y >= int(ShiftLab::SIZE)) continue;
            const uint32_t other = uint32_t(y) * ShiftLab::SIZE + uint32_t(x);
            if (lab.sees(other)) return other;
        }
    };
    std::vector<OfferedPath> paths;
    std::vector<uint32_t> from, to;
    for (const OfferedPath& path : lab.offered(trees)) {
        if (path.pathId == 0) continue;
        // Reconnection alone shifts nothing else.
        if (shift == Shift::Reconnection && path.reconnectionIndex == 0 && path.pathId != 2) continue;
        paths.push_back(path);
        from.push_back(path.seedPixel);
        to.push_back(nearby(path.seedPixel));
    }
    const std::vector<ShiftedPath> home = lab.shifted(paths, from), away = lab.shifted(paths, to);

    std::vector<Tree> drawing;
    std::vector<size_t> drawn; // which path each of them draws
    for (size_t i = 0; i < paths.size(); ++i) {
        Tree tree;
        if (!treeOf(paths[i], away[i], to[i], tree)) continue;
        drawing.push_back(tree);
        drawn.push_back(i);
    }
    const std::vector<OfferedPath> all = lab.offered(drawing);
    std::vector<OfferedPath> there(paths.size());
    for (size_t i = 0; i < drawn.size(); ++i)
        there[drawn[i]] = all[i * shared::SHIFT_PATHS + paths[drawn[i]].pathId - 2];
    const std::vector<ShiftedPath> back = lab.shifted(there, from);

    ShiftFindings found;
    for (size_t i = 0; i < paths.size(); ++i) {
        const OfferedPath& path = paths[i];
        found.home.add(isDone(home[i]) ? relative(dvec3(home[i].f), measured(path)) : 1);
        ++found.outcomes[int(away[i].f.w)];
        const bool isDrawn = isSamePath(there[i], path);
        if (!isDone(away[i])) {
            found.undefined.add(isDrawn ? 1 : 0);
            continue;
        }
        if (!isDrawn) {
            for (Tally* tally : {&found.back, &found.product, &found.jacobian, &found.density}) tally->add(1);
            continue;
        }
        const dvec3 arrived = dvec3(away[i].f) / double{path.density},
                    returned = dvec3(back[i].f) / double{there[i].density};
        const double numeric = path.reconnectionIndex == 0 ? 1 : densityIn(path, away[i]) / densityIn(path, home[i]);
        const double j = glm::length(arrived) / glm::length(dvec3(there[i].f)),
                     jBack = glm::length(returned) / glm::length(dvec3(path.f));
        found.back.add(isDone(back[i]) ? relative(dvec3(back[i].f), measured(path)) : 1);
        found.product.add(std::abs(j * jBack - 1));
        found.jacobian.add(relative(arrived, dvec3(there[i].f) * numeric));
        found.density.add(std::abs(double{away[i].density.x} / double{there[i].density} - 1));
        ++found.kinds[kindOf(path, home[i])];
        ++found.kinds[ENDINGS[size_t(path.suffix.w)]];
    }
    return found;
}

std::vector<std::pair<const char*, const Tally*>> ShiftFindings::tallies() const
{
    return {{"home", &home},
            {"T after its inverse", &back},
            {"J times its inverse", &product},
            {"J by its numbers", &jacobian},
            {"density", &density},
            {"undefined both ways", &undefined}};
}

} // namespace support
