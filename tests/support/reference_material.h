#pragma once
// Surfaces and their scattering, in float64, for the reference tracer. Written from
// docs/LIGHT_TRANSPORT.md alone: whatever the shaders have in common with this file, they have from that text.

#include <random>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace support
{

using Random = std::mt19937_64;
double uniform(Random& random); // in [0, 1)

// Where a ray met a triangle: weights of the second and third vertex.
struct ReferencePoint {
    uint32_t triangle = scene::NONE;
    double u = 0, v = 0;
};

double alphaOf(const scene::Scene& scene, const ReferencePoint& at); // the probability that the surface exists here

// The radiance that leaves towards w_o, of emissive and unlit materials.
glm::dvec3 emissionOf(const scene::Scene& scene, const ReferencePoint& at, const glm::dvec3& wo);

glm::dvec3 positionOf(const scene::Scene& scene, const ReferencePoint& at);
glm::dvec3 frontNormal(const scene::Scene& scene, uint32_t triangle); // unit, geometric

// A surface seen from w_o: everything "Material at a point" names, normals on the side of w_o.
class ReferenceSurface
{
  public:
    ReferenceSurface(const scene::Scene& scene, const ReferencePoint& at, const glm::dvec3& wo);

    glm::dvec3 evaluate(const glm::dvec3& wi) const; // f without its Dirac part
    double density(const glm::dvec3& wi) const;      // of sample(), per solid angle, without its Dirac part
    double cosine(const glm::dvec3& wi) const { return glm::abs(glm::dot(wi, shadingNormal_)); }

    struct Sample {
        glm::dvec3 wi;
        glm::dvec3 weight = glm::dvec3(0); // f |cos| / density, or that of the Dirac lobe
        bool dirac = false;
    };
    Sample sample(Random& random) const;

    const glm::dvec3& shadingNormal() const { return shadingNormal_; }

  private:
    enum Lobe { Diffuse, Reflection, Transmission };

    glm::dvec3 dielectricFresnel(double c) const;
    glm::dvec3 fresnel(double c) const;
    double distribution(double cosH) const;
    double masking(double cosO, double cosI) const;
    glm::dvec3 halfVectorOfRefraction(const glm::dvec3& wi) const;
    glm::dvec3 evaluateDiffuse(double cosO, double cosI) const;
    glm::dvec3 evaluateTransmission(const glm::dvec3& wi) const;
    double transmissionDensity(const glm::dvec3& wi) const;
    Sample sampleDirac(Lobe lobe) const;
    bool scatters(const glm::dvec3& wi, bool transmitted) const;

    glm::dvec3 wo_, geometricNormal_, shadingNormal_;
    glm::dvec3 base_, diffuse_, specularColor_, normalIncidence_; // b, rho, ., F0d
    double metallic_, transmission_, specular_, width_, eta_;     // m, t, s, alpha_g, eta
    bool transmissive_, thin_, dirac_, unlit_;
    double probability_[3] = {0, 0, 0}; // of the lobes
};

} // namespace support
