#include "engine/scene/bvh_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

namespace scene
{

namespace
{

constexpr uint32_t ROUNDS = 8;          // after these, few of the pairs that could be are missing
constexpr uint32_t LONGEST_SEARCH = 64; // triangles around a vertex: more only where very many are the same

struct Partner {
    uint32_t triangle = NONE;
    uint32_t turn = 0;      // of the triangle that asks
    uint32_t otherTurn = 0; // of this one
};

class Pairing
{
  public:
    Pairing(const BvhInput& input, std::span<const uint32_t> usable, Edges edges)
        : input_(input), usable_(usable), vertices_(vertexNumbers(input.positions, edges)),
          taken_(input.triangles.size(), true)
    {
        for (const uint32_t triangle : usable) taken_[triangle] = needsAlphaTest(triangle);
        listTriangles();
    }

    std::vector<TrianglePair> run()
    {
        std::vector<TrianglePair> pairs;
        std::vector<Partner> best(input_.triangles.size());
        for (uint32_t round = 0; round < ROUNDS; ++round) {
            const size_t before = pairs.size();
            for (const uint32_t triangle : usable_)
                best[triangle] = taken_[triangle] ? Partner{} : bestPartner(triangle);
            for (const uint32_t triangle : usable_) {
                const Partner& partner = best[triangle];
                if (partner.triangle == NONE || triangle > partner.triangle ||
                    best[partner.triangle].triangle != triangle)
                    continue;
                pairs.push_back({triangle, partner.triangle, partner.turn, partner.otherTurn});
                taken_[triangle] = taken_[partner.triangle] = true;
            }
            if (pairs.size() == before) break;
        }
        for (const uint32_t triangle : usable_)
            if (!taken_[triangle] || needsAlphaTest(triangle)) pairs.push_back({.first = triangle});
        return pairs;
    }

  private:
    // Numbers for vertices, equal where they may share an edge. Positions by their bits, which have an order also where
    // they are no numbers.
    static std::vector<uint32_t> vertexNumbers(std::span<const glm::vec3> positions, Edges edges)
    {
        const auto key = [&](uint32_t i) {
            const glm::vec3 p = positions[i] + 0.0f; // -0 becomes 0
            return std::tuple(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z));
        };
        std::vector<uint32_t> order(positions.size());
        std::iota(order.begin(), order.end(), 0u);
        if (edges == Edges::OfVertices) return order;
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
        std::vector<uint32_t> numbers(positions.size());
        for (size_t i = 0; i < order.size(); ++i)
            numbers[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? numbers[order[i - 1]] : order[i];
        return numbers;
    }

    bool needsAlphaTest(uint32_t triangle) const
    {
        return !input_.needsAlphaTest.empty() && input_.needsAlphaTest[triangle] != 0;
    }
    uint32_t vertex(uint32_t triangle, uint32_t corner) const
    {
        return vertices_[input_.triangles[triangle].vertices[corner % 3]];
    }

    // The triangles around each vertex.
    void listTriangles()
    {
        begin_.resize(vertices_.size() + 1);
        for (const uint32_t triangle : usable_)
            for (uint32_t corner = 0; corner < 3; ++corner) ++begin_[vertex(triangle, corner) + 1];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        around_.resize(3 * usable_.size());
        std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (const uint32_t triangle : usable_)
            for (uint32_t corner = 0; corner < 3; ++corner) around_[next[vertex(triangle, corner)]++] = triangle;
    }

    Box boxOf(uint32_t triangle) const
    {
        Box box;
        for (const uint32_t v : input_.triangles[triangle].vertices)
            box.extend({input_.positions[v], input_.positions[v]});
        return box;
    }

    // Of the triangles across the edges, the one with which a common box saves most, if any.
    Partner bestPartner(uint32_t triangle) const
    {
        Partner best;
        const Box box = boxOf(triangle);
        std::tuple<float, uint32_t> least = {1.0f, 0};
        for (uint32_t turn = 0; turn < 3; ++turn) {
            const uint32_t from = vertex(triangle, turn + 1), to = vertex(triangle, turn + 2);
            const auto countAt = [&](uint32_t v) { return begin_[v + 1] - begin_[v]; };
            const uint32_t searched = countAt(from) < countAt(to) ? from : to;
            for (uint32_t i = 0; i < std::min(countAt(searched), LONGEST_SEARCH); ++i) {
                const uint32_t other = around_[begin_[searched] + i];
                if (taken_[other] || other == triangle) continue;
                for (uint32_t otherTurn = 0; otherTurn < 3; ++otherTurn) {
                    if (vertex(other, otherTurn + 1) != to || vertex(other, otherTurn + 2) != from) continue;
                    Box both = boxOf(other);
                    const float apart = box.halfArea() + both.halfArea();
                    both.extend(box);
                    const std::tuple<float, uint32_t> cost = {both.halfArea() / apart, other};
                    if (cost < least) {
                        least = cost;
                        best = {other, turn, otherTurn};
                    }
                }
            }
        }
        return best;
    }

    const BvhInput& input_;
    std::span<const uint32_t> usable_;
    std::vector<uint32_t> vertices_;
    std::vector<bool> taken_;
    std::vector<uint32_t> begin_, around_; // by vertex: its part of around_
};

} // namespace

std::vector<TrianglePair> pairTriangles(const BvhInput& input, std::span<const uint32_t> usable, Edges edges)
{
    return Pairing(input, usable, edges).run();
}

bool follow(TrianglePair& pair, const BvhInput& input)
{
    if (pair.second == NONE) return true;
    const auto verticesOf = [&](uint32_t triangle) { return input.triangles[triangle].vertices; };
    const auto share = [&](const TrianglePair& p) {
        const auto a = verticesOf(p.first), b = verticesOf(p.second);
        return a[(p.firstTurn + 1) % 3] == b[(p.secondTurn + 2) % 3] &&
               a[(p.firstTurn + 2) % 3] == b[(p.secondTurn + 1) % 3];
    };
    const auto isPoint = [&](uint32_t triangle) {
        const auto v = verticesOf(triangle);
        return v[0] == v[1] && v[1] == v[2];
    };
    TrianglePair mirrored = pair;
    mirrored.firstTurn = (3 - pair.firstTurn) % 3;
    mirrored.secondTurn = (3 - pair.secondTurn) % 3;
    if (share(pair)) return true;
    if (share(mirrored))
        pair = mirrored;
    else if (isPoint(pair.second))
        pair = {.first = pair.first, .firstTurn = pair.firstTurn};
    else if (isPoint(pair.first))
        pair = {.first = pair.second, .firstTurn = pair.secondTurn};
    else
        return false;
    return true;
}

} // namespace scene
