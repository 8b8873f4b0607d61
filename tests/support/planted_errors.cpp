#include "tests/support/planted_errors.h"

#include "engine/base/error.h"

namespace support
{

const std::vector<PlantedError>& plantedErrors()
{
    static const std::vector<PlantedError> list = {
        {"WeightTimes1_02", "restir/reservoir.glsl", "here.weightSum = sumOf(value,",
         "here.weightSum = 1.02 * sumOf(value,"},
        {"MissingJacobian", "canonical.comp", "finiteOrCounted(f * density, STAGE)", "f"},
        {"SwappedTemporalMis", "restir/reservoir.glsl", "here.weightSum * rest(historyConfidence, rho, confidence);",
         "here.weightSum * rest(confidence, rho, historyConfidence);"},
        {"SwappedSpatialMis", "restir/reservoir.glsl", "part * share(m.neighborConfidence, b, m.confidence);",
         "part * share(m.confidence, b, m.neighborConfidence);"},
        {"TemporalConfidenceOffByOne", "restir/reservoir.glsl",
         "here.weightSum * rest(historyConfidence, rho, confidence);",
         "here.weightSum * rest(historyConfidence + 1.0, rho, confidence);"},
        {"SpatialConfidenceOffByOne", "restir/reservoir.glsl", "share(m.confidence, a, m.neighborConfidence);",
         "share(m.confidence, a, m.neighborConfidence + 1.0);"},
        {"StaleTarget", "temporal.comp", "r[c].f = fHere[c];", "r[c].f = old[c].f;"},
        {"EmptyHistoryForgotten", "temporal.comp", "if (historyConfidence == 0u ||",
         "if (loadHistoryHead(previousPixel, 0u).weightSum == 0.0 || historyConfidence == 0u ||"},
        {"FailedShiftForgotten", "restir/reservoir.glsl", "        here.weightSum = weight;\n", ""},
        {"LuminanceWeights", "temporal.comp", "ratio(targetOf(c, fThere[c]), targetOf(c, r[c].f))",
         "ratio(dot(vec3(1.0), fThere[c]), dot(vec3(1.0), r[c].f))"},
        {"NeighborsByContent", "spatial_gather.comp", "neighborIn(neighbor, slot) == pixel ?",
         "neighborIn(neighbor, slot) == pixel && loadReservoirsHead(neighbor, 0u).weightSum > 0.0 ?"},
        {"PathOfAnother", "spatial_gather.comp", "loadReservoirsPath(lender[c], c)", "loadReservoirsPath(pixel, c)"},
        // What shows only where the scene moves.
        {"PreviousWorldForgotten", "scene/bindings.glsl", "previous && BETWEEN_WORLDS ? 1u - frame.world : frame.world",
         "frame.world"},
        {"StaleSuffix", "temporal.comp", "if (BETWEEN_WORLDS ||", "if (false &&"},
        {"StretchingForgotten", "path/reconnection.glsl", "TWO_WORLDS ? s.area : 1.0", "1.0"},
        // What weighted color alone shows: reservoirs stay right.
        {"ColorOfOwnWeightTimes1_02", "temporal.comp", "color += weight * colorOf", "color += 1.02 * weight * colorOf"},
        {"ColorBySwappedTemporalWeights", "temporal.comp",
         "color += weight * colorOf(c, r[c].f) + historyWeight * colorOf(c, fHere[c]);",
         "color += historyWeight * colorOf(c, r[c].f) + weight * colorOf(c, fHere[c]);"},
        {"ColorFromTheHistorysDomain", "temporal.comp", "historyWeight * colorOf(c, fHere[c])",
         "historyWeight * colorOf(c, old[c].f)"},
        {"ColorFromTheNeighborsDomain", "spatial_gather.comp", "weighted += weight * colorOf(c, fHere);",
         "weighted += weight * colorOf(c, other.f);"},
        {"ColorByTheOwnMisWeight", "spatial_gather.comp", "weighted += weight * colorOf(c, fHere);",
         "weighted += otherConfidence / (confidence + neighborConfidence) * share(neighborConfidence, b, confidence) "
         "*\n"
         "            (other.weightSum + other.carry) * colorOf(c, fHere);"},
        {"ColorOfTheOwnSampleWhole", "spatial_gather.comp", "(r[c].weightSum * merge[c].kept + r[c].carry)",
         "(r[c].weightSum + r[c].carry)"},
        {"ColorOfAKeptShare2PercentTooLarge", "spatial_gather.comp", "(r[c].weightSum * merge[c].kept + r[c].carry)",
         "(r[c].weightSum * (merge[c].kept + 0.04 * (1.0 - merge[c].kept)) + r[c].carry)"},
        {"ColorOfTheFirstPathTwice", "canonical.comp", "allPaths += f;",
         "allPaths += canonical[0].weightSum > 0.0 ? f : 2.0 * f;"},
        // What mutations of history's samples alone show.
        {"MutationWithoutDensities", "restir/mutation.glsl", " / y.density) * odds;", ") * odds;"},
        {"MutationTooOften", "restir/mutation.glsl", "threshold[c] = decision", "threshold[c] = 0.9 * decision"},
        {"MutationForgetsTheOdds", "restir/mutation.glsl", ") * odds;", ");"},
        {"MutationKeepsAnotherMeasure", "restir/mutation.glsl", "mutated[c].f = stored;", "mutated[c].f = f;"},
        {"MutationToAnotherKind", "restir/mutation.glsl", "x.pathId != sought[c]", "sought[c] == 0u"},
        {"MutationByChosenPathsAlone", "canonical.comp", "    if (MUTATES) endMutation(pixel);",
         "    if (MUTATES && canonical[0].chosen.pathId == mutated[0].chosen.pathId) endMutation(pixel);"},
        {"MutationInAnotherDomain", "mutate.comp", "makeDomain(pixel, true)", "makeDomain(pixel, false)"},
        {"MutationForgetsTheDensityInTime", "temporal.comp", "old[c].chosen = renewed(c);",
         "{ old[c].chosen = renewed(c); old[c].chosen.density = 1.0; }"},
        {"MutationForgetsTheDensityInSpace", "spatial_gather.comp", "densityFrom(neighbor, slot, c);", "1.0;"},
        {"MutationByTheDensityElsewhere", "path/shift.glsl",
         "moving[c].density = densityOf(x.k + 1u, moving[c].pathId, pdf * measure, departure);", ""},
        // What the color estimate beside reservoirs alone shows.
        {"EstimateClamped", "temporal.comp",
         "roundedAtRandom(history, newShare * (news - history) + (1.0 - newShare) * difference, random)",
         "max(vec3(0.0), history + newShare * (news - history) + (1.0 - newShare) * difference)"},
        {"EstimateRatioFromTheSample", "temporal.comp", "albedoRatio(newColor.w, oldColor.w)",
         "min(fHere[0] / max(old[0].f, 1e-6), 2.0)"},
        {"EstimateShareKnowsTheSamples", "temporal.comp", "    return roundedAtRandom(history,",
         "    if (news.x > history.x) newShare *= 0.5;\n"
         "    return roundedAtRandom(history,"},
        {"EstimateRatioForgottenOnce", "temporal.comp", "vec2(confidence, historyConfidence), k)",
         "vec2(confidence, historyConfidence), vec3(1.0))"},
        {"EstimateFromTheHistorysDomain", "restir/estimator.glsl",
         "restTimes(confidence.x, rhoThere, confidence.y) * colorOf(c, fHere)",
         "restTimes(confidence.x, rhoThere, confidence.y) * colorOf(c, there.f)"},
        {"EstimateBySwappedMis", "restir/estimator.glsl", "rest(confidence.y, rho, confidence.x) * colorOf(c, here.f)",
         "rest(confidence.x, rho, confidence.y) * colorOf(c, here.f)"},
        {"EstimateOfNeighborsTimes1_02", "spatial_gather.comp", "weighted += beta * (k * colorOfRow",
         "weighted += beta * (1.02 * k * colorOfRow"},
        {"EstimateOfTenthsOfTheDifference", "spatial_gather.comp", "weighted += beta * colorDifference",
         "weighted += 0.9 * beta * colorDifference"},
        // Of these the toy knows nothing: they are in what it stands for.
        {"MissingGeometryTerm", "path/shift.glsl", "abs(dot(at.geometricNormal, direction)) / squared;",
         "abs(dot(at.geometricNormal, direction));"},
        {"MissingDeparture", "path/reconnection.glsl", "arrival : arrival * departure;", "arrival : arrival;"},
        // Faults that the program had until they were mended, each taken out of its mend again.
        {"SkyDecodedTwice", "scene/lights.glsl", "        vec4 environment = loadTexel(texel);\n",
         "        texel.y = min(uint(acos(clamp(l.direction.y, -1.0, 1.0)) / PI * float(scene.environmentHeight)),\n"
         "                      scene.environmentHeight - 1u);\n"
         "        vec4 environment = loadTexel(texel);\n"},
        {"WalksMeasuredFromTheSurface", "path/walk.glsl", "vec3 d = next.position - origin;",
         "vec3 d = next.position - origin - 1.9073486e-6 * x.s.geometricNormal;"},
        {"OffsetsByTheScenesSize", "lib/offset.glsl", "return 2.0 * POSITION_ERROR * dot(abs(geometricNormal), size);",
         "return 8.0 * POSITION_ERROR;"},
        {"PathsOnEdges", "scene/surface.glsl", "    if (leastWeight(barycentric) < g.clearance) {\n",
         "    if (false) {\n"},
        {"EdgesAskTwice", "scene/surface.glsl", "return all(meets) ?", "return true ?"},
    };
    return list;
}

const PlantedError& plantedError(const std::string& name)
{
    std::string names;
    for (const PlantedError& error : plantedErrors()) {
        if (name == error.name) return error;
        names += (names.empty() ? "" : ", ") + std::string(error.name);
    }
    throw Error("There is no planted error \"{}\"; there are: {}.", name, names);
}

} // namespace support
