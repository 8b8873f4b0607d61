#pragma once
// What luminance, RGB and N channels differ by: one table each, and no code.

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "passes/settings.h"

namespace passes
{

// C reservoirs and two C x 3 tables of non-negative weights (the paper's Algorithm 3, generalised):
//     target:  reservoir c resamples by p_hat_c(f) = <target[c], f>
//     resolve: color = sum over c of resolve[c] * f(Y_c) W_c, component by component
// Unbiased if and only if in every channel the resolve weights sum to 1, and a channel that a reservoir resolves is in
// its target (else its samples miss light).
struct Estimator {
    std::string name; // as --method
    std::vector<glm::vec3> target;
    std::vector<glm::vec3> resolve;
};

// The table of a ReSTIR method. Throws Error when the table is not unbiased (checkUnbiased).
const Estimator& estimatorOf(Method method);

const std::vector<Estimator>& estimators();

// Whether each target is one channel alone: then all samples of a reservoir have the same color per unit of target, and
// nothing is left to chance that another way of reading color would mend.
bool oneHot(const Estimator& estimator);

// How this method's color has to be read: Chosen where Settings::color makes no difference.
Color colorReading(const Settings& settings);

// Throws Error naming the estimator, the channel and the condition that fails.
void checkUnbiased(const Estimator& estimator);

} // namespace passes
