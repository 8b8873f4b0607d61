#include "tests/support/reference_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace support
{

namespace
{

using glm::dvec2, glm::dvec3, glm::dvec4, glm::dot, glm::cross, glm::normalize;

constexpr double PI = std::numbers::pi;
constexpr double DIRAC_BELOW = 1.0 / 4096; // GGX widths

double decodeSrgb(double s)
{
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

int64_t wrapped(int64_t i, int64_t size, scene::Wrap wrap)
{
    const auto modulo = [](int64_t a, int64_t n) { return (a % n + n) % n; };
    switch (wrap) {
    case scene::Wrap::Repeat: return modulo(i, size);
    case scene::Wrap::Clamp: return std::clamp<int64_t>(i, 0, size - 1);
    case scene::Wrap::Mirror: break;
    }
    const int64_t j = modulo(i, 2 * size);
    return j < size ? j : 2 * size - 1 - j;
}

enum class Encoding { Linear, Srgb };

dvec4 texel(const scene::Image& image, const scene::TextureUse& use, int64_t x, int64_t y, Encoding encoding)
{
    const int64_t column = wrapped(x, image.width, use.wrapU), row = wrapped(y, image.height, use.wrapV);
    const size_t start = 4 * static_cast<size_t>(row * image.width + column);
    const auto channel = [&](size_t c) {
        return image.deep.empty() ? image.rgba[start + c] / 255.0 : image.deep[start + c] / 65535.0;
    };
    dvec4 value(channel(0), channel(1), channel(2), channel(3));
    if (encoding == Encoding::Srgb)
        for (int c = 0; c < 3; ++c) value[c] = decodeSrgb(value[c]);
    return value;
}

template <class T>
auto interpolate(const std::vector<T>& values, const scene::Scene& scene, const ReferencePoint& at)
{
    using Wide = glm::vec<T::length(), double>;
    const auto& [a, b, c] = scene.triangles[at.triangle].vertices;
    return (1 - at.u - at.v) * Wide(values[a]) + at.u * Wide(values[b]) + at.v * Wide(values[c]);
}

// The texture at the point; 1 where there is none.
dvec4 textured(const scene::Scene& scene, const ReferencePoint& at, const scene::TextureUse& use, Encoding encoding)
{
    if (use.image == scene::NONE) return dvec4(1);
    const dvec2 set = interpolate(use.uvSet == 0 ? scene.uv0 : scene.uv1, scene, at);
    const dvec3 uv1(set, 1);
    const scene::Image& image = scene.images[use.image];
    const double x = dot(dvec3(use.row0), uv1) * image.width, y = dot(dvec3(use.row1), uv1) * image.height;
    if (use.nearest)
        return texel(image, use, static_cast<int64_t>(std::floor(x)), static_cast<int64_t>(std::floor(y)), encoding);
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5); // texel centres are at halves
    const double s = x - 0.5 - left, t = y - 0.5 - top;
    const auto i = static_cast<int64_t>(left), j = static_cast<int64_t>(top);
    return (1 - t) * ((1 - s) * texel(image, use, i, j, encoding) + s * texel(image, use, i + 1, j, encoding)) +
           t * ((1 - s) * texel(image, use, i, j + 1, encoding) + s * texel(image, use, i + 1, j + 1, encoding));
}

const scene::Material& materialOf(const scene::Scene& scene, const ReferencePoint& at)
{
    return scene.materials[scene.triangles[at.triangle].material];
}

dvec4 baseColorAt(const scene::Scene& scene, const ReferencePoint& at)
{
    const scene::Material& m = materialOf(scene, at);
    dvec4 color = dvec4(m.baseColor) * textured(scene, at, m.baseColorTexture, Encoding::Srgb);
    if (!scene.colors.empty()) color *= interpolate(scene.colors, scene, at);
    return color;
}

double fifth(double x)
{
    return x * x * x * x * x;
}

// Unpolarised, of light that meets a plane interface at cosine c; 1 in total internal reflection.
double exactReflectance(double c, double eta)
{
    const double cosT2 = 1 - (1 - c * c) / (eta * eta);
    if (cosT2 <= 0) return 1;
    const double cosT = std::sqrt(cosT2);
    const double s = (c - eta * cosT) / (c + eta * cosT), p = (eta * c - cosT) / (eta * c + cosT);
    return (s * s + p * p) / 2;
}

dvec3 mirrored(const dvec3& w, const dvec3& normal)
{
    return 2 * dot(w, normal) * normal - w;
}

// Through an interface whose normal is on the side of w (Snell); false in total internal reflection.
bool refracted(const dvec3& w, const dvec3& normal, double eta, dvec3& result)
{
    const double c = dot(w, normal), cosT2 = 1 - (1 - c * c) / (eta * eta);
    if (cosT2 <= 0) return false;
    result = -w / eta + (c / eta - std::sqrt(cosT2)) * normal;
    return true;
}

dvec3 inFrame(const dvec3& normal, double cosTheta, double phi)
{
    const dvec3 tangent = normalize(cross(normal, std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return sinTheta * std::cos(phi) * tangent + sinTheta * std::sin(phi) * cross(normal, tangent) + cosTheta * normal;
}

double mean(const dvec3& color)
{
    return (color.x + color.y + color.z) / 3;
}

} // namespace

double uniform(Random& random)
{
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

double alphaOf(const scene::Scene& scene, const ReferencePoint& at)
{
    const scene::Material& m = materialOf(scene, at);
    if (m.alpha == scene::Alpha::Opaque) return 1;
    const double alpha = baseColorAt(scene, at).a;
    if (m.alpha == scene::Alpha::Mask) return alpha >= double{m.alphaCutoff} ? 1 : 0;
    return std::clamp(alpha, 0.0, 1.0);
}

dvec3 emissionOf(const scene::Scene& scene, const ReferencePoint& at, const dvec3& wo)
{
    const scene::Material& m = materialOf(scene, at);
    if (m.unlit) return dvec3(baseColorAt(scene, at));
    if (m.emission == glm::vec3(0)) return dvec3(0);
    if (!m.doubleSided && dot(frontNormal(scene, at.triangle), wo) <= 0) return dvec3(0);
    return dvec3(m.emission) * dvec3(textured(scene, at, m.emissiveTexture, Encoding::Srgb));
}

dvec3 positionOf(const scene::Scene& scene, const ReferencePoint& at)
{
    return interpolate(scene.positions, scene, at);
}

dvec3 frontNormal(const scene::Scene& scene, uint32_t triangle)
{
    const auto& [a, b, c] = scene.triangles[triangle].vertices;
    const dvec3 corner = scene.positions[a];
    return normalize(cross(dvec3(scene.positions[b]) - corner, dvec3(scene.positions[c]) - corner));
}

ReferenceSurface::ReferenceSurface(const scene::Scene& scene, const ReferencePoint& at, const dvec3& wo) : wo_(wo)
{
    const scene::Material& m = materialOf(scene, at);

    geometricNormal_ = frontNormal(scene, at.triangle);
    const dvec3 n = normalize(interpolate(scene.normals, scene, at));
    shadingNormal_ = n;
    if (m.normalTexture.image != scene::NONE) {
        const dvec4 tangent = interpolate(scene.tangents, scene, at);
        const dvec3 t = normalize(dvec3(tangent)), b = tangent.w * cross(n, t);
        dvec3 bump = dvec3(textured(scene, at, m.normalTexture, Encoding::Linear)) * 2.0 - 1.0;
        bump.x *= m.normalScale;
        bump.y *= m.normalScale;
        shadingNormal_ = normalize(bump.x * t + bump.y * b + bump.z * n);
    }
    const bool front = dot(wo, geometricNormal_) >= 0;
    if (!front) {
        geometricNormal_ = -geometricNormal_;
        shadingNormal_ = -shadingNormal_;
    }
    if (dot(wo, shadingNormal_) <= 0) shadingNormal_ = geometricNormal_;

    base_ = dvec3(baseColorAt(scene, at));
    const dvec4 metallicRoughness = textured(scene, at, m.metallicRoughnessTexture, Encoding::Linear);
    metallic_ = m.metallic * metallicRoughness.b;
    const double roughness = m.roughness * metallicRoughness.g;
    width_ = roughness * roughness;
    dirac_ = width_ < DIRAC_BELOW;
    transmissive_ = m.transmission > 0;
    const double transmitted = m.transmission * textured(scene, at, m.transmissionTexture, Encoding::Linear).r;
    transmission_ = transmitted * (1 - metallic_);
    diffuse_ = base_ * (1 - metallic_) * (1 - transmitted);
    specular_ = m.specular * textured(scene, at, m.specularTexture, Encoding::Linear).a;
    specularColor_ = dvec3(m.specularColor) * dvec3(textured(scene, at, m.specularColorTexture, Encoding::Srgb));
    const double normalReflectance = std::pow((m.ior - 1.0) / (m.ior + 1.0), 2);
    normalIncidence_ = glm::min(normalReflectance * specularColor_, dvec3(1));
    thin_ = m.thin;
    eta_ = m.thin || front ? m.ior : 1 / double{m.ior};
    unlit_ = m.unlit;

    // Any probabilities serve as long as each lobe that reflects has one; these are near its share at normal incidence.
    if (unlit_) return;
    const bool glossy = specular_ > 0 || metallic_ > 0;
    const double weights[3] = {mean(diffuse_), glossy ? 0.1 + mean(fresnel(dot(wo, shadingNormal_))) : 0,
                               transmission_ > 0 ? 0.1 + transmission_ * mean(base_) : 0};
    const double sum = weights[0] + weights[1] + weights[2];
    for (int lobe = 0; lobe < 3 && sum > 0; ++lobe) probability_[lobe] = weights[lobe] / sum;
}

// F_d
dvec3 ReferenceSurface::dielectricFresnel(double c) const
{
    if (!transmissive_) return specular_ * (normalIncidence_ + (1.0 - normalIncidence_) * fifth(1 - c));
    return glm::min(specular_ * specularColor_ * exactReflectance(c, eta_), dvec3(1));
}

// F
dvec3 ReferenceSurface::fresnel(double c) const
{
    const dvec3 metal = base_ + (1.0 - base_) * fifth(1 - c);
    return (1 - metallic_) * dielectricFresnel(c) + metallic_ * metal;
}

// D, of a half vector at this cosine to n_s
double ReferenceSurface::distribution(double cosH) const
{
    const double a2 = width_ * width_, cos2 = cosH * cosH;
    const double q = (1 - cos2) / a2 + cos2;
    return 1 / (PI * a2 * q * q);
}

// G2
double ReferenceSurface::masking(double cosO, double cosI) const
{
    const auto lambda = [&](double c) {
        const double tan2 = (1 - c * c) / (c * c);
        return (std::sqrt(1 + width_ * width_ * tan2) - 1) / 2;
    };
    return 1 / (1 + lambda(cosO) + lambda(cosI));
}

bool ReferenceSurface::scatters(const dvec3& wi, bool transmitted) const
{
    const double byShading = dot(wi, shadingNormal_), byGeometry = dot(wi, geometricNormal_);
    return transmitted ? byShading < 0 && byGeometry < 0 : byShading > 0 && byGeometry > 0;
}

dvec3 ReferenceSurface::evaluateDiffuse(double cosO, double cosI) const
{
    const auto q = [](double c) { return 1 - fifth(1 - c); };
    const double f0 = std::max({normalIncidence_.x, normalIncidence_.y, normalIncidence_.z});
    return diffuse_ / PI * ((1 - specular_) + specular_ * (22.0 / 21) * (1 - f0) * q(cosO) * q(cosI));
}

// On the side of w_o when it is to be seen from there.
dvec3 ReferenceSurface::halfVectorOfRefraction(const dvec3& wi) const
{
    const dvec3 h = normalize(wo_ + eta_ * wi);
    return dot(wo_, h) < 0 ? -h : h;
}

dvec3 ReferenceSurface::evaluateTransmission(const dvec3& wi) const
{
    const double cosO = dot(wo_, shadingNormal_), cosI = std::abs(dot(wi, shadingNormal_));
    if (thin_) {
        const dvec3 above = wi - 2 * dot(wi, shadingNormal_) * shadingNormal_;
        const dvec3 h = normalize(wo_ + above);
        return transmission_ * base_ * (1.0 - dielectricFresnel(std::abs(dot(wo_, h)))) *
               (distribution(dot(h, shadingNormal_)) * masking(cosO, cosI) / (4 * cosO * cosI));
    }
    const dvec3 h = halfVectorOfRefraction(wi);
    const double oh = dot(wo_, h), ih = dot(wi, h), cosH = dot(h, shadingNormal_);
    if (ih >= 0 || cosH <= 0) return dvec3(0);
    const double denominator = oh + eta_ * ih;
    return transmission_ * base_ * (1.0 - dielectricFresnel(oh)) *
           (distribution(cosH) * masking(cosO, cosI) * eta_ * eta_ * std::abs(ih) * oh /
            (cosI * cosO * denominator * denominator));
}

dvec3 ReferenceSurface::evaluate(const dvec3& wi) const
{
    if (unlit_) return dvec3(0);
    if (scatters(wi, true)) return dirac_ || transmission_ <= 0 ? dvec3(0) : evaluateTransmission(wi);
    if (!scatters(wi, false)) return dvec3(0);
    const double cosO = dot(wo_, shadingNormal_), cosI = dot(wi, shadingNormal_);
    dvec3 f = evaluateDiffuse(cosO, cosI);
    if (!dirac_) {
        const dvec3 h = normalize(wo_ + wi);
        f += fresnel(std::abs(dot(wo_, h))) *
             (distribution(dot(h, shadingNormal_)) * masking(cosO, cosI) / (4 * cosO * cosI));
    }
    return f;
}

double ReferenceSurface::transmissionDensity(const dvec3& wi) const
{
    if (thin_) {
        const dvec3 h = normalize(wo_ + wi - 2 * dot(wi, shadingNormal_) * shadingNormal_);
        const double cosH = dot(h, shadingNormal_);
        return distribution(cosH) * cosH / (4 * std::abs(dot(wo_, h)));
    }
    const dvec3 h = halfVectorOfRefraction(wi);
    const double oh = dot(wo_, h), ih = dot(wi, h), cosH = dot(h, shadingNormal_);
    if (ih >= 0 || cosH <= 0) return 0;
    const double denominator = oh + eta_ * ih;
    return distribution(cosH) * cosH * eta_ * eta_ * std::abs(ih) / (denominator * denominator);
}

double ReferenceSurface::density(const dvec3& wi) const
{
    const double cosI = dot(wi, shadingNormal_);
    if (cosI < 0)
        return dirac_ || probability_[Transmission] == 0 ? 0 : probability_[Transmission] * transmissionDensity(wi);
    double result = probability_[Diffuse] * cosI / PI;
    if (!dirac_ && probability_[Reflection] > 0) {
        const dvec3 h = normalize(wo_ + wi);
        const double cosH = dot(h, shadingNormal_);
        result += probability_[Reflection] * distribution(cosH) * cosH / (4 * std::abs(dot(wo_, h)));
    }
    return result;
}

ReferenceSurface::Sample ReferenceSurface::sampleDirac(Lobe lobe) const
{
    const double cosO = dot(wo_, shadingNormal_);
    Sample result = {.wi = -wo_, .dirac = true};
    if (lobe == Reflection) {
        result.wi = mirrored(wo_, shadingNormal_);
        if (scatters(result.wi, false)) result.weight = fresnel(cosO) / probability_[Reflection];
        return result;
    }
    if (!thin_ && !refracted(wo_, shadingNormal_, eta_, result.wi)) return result;
    if (scatters(result.wi, true))
        result.weight = transmission_ * base_ * (1.0 - dielectricFresnel(cosO)) / probability_[Transmission];
    return result;
}

// Directions by cosine, or half vectors by D cos: the simplest densities that cover each lobe.
ReferenceSurface::Sample ReferenceSurface::sample(Random& random) const
{
    Sample result = {.wi = shadingNormal_};
    const double choice = uniform(random), a = uniform(random), phi = 2 * PI * uniform(random);
    const Lobe lobe = choice < probability_[Diffuse]                              ? Diffuse
                      : choice < probability_[Diffuse] + probability_[Reflection] ? Reflection
                                                                                  : Transmission;
    if (probability_[lobe] == 0) return result; // black, or the last lobe by rounding
    if (lobe == Diffuse) {
        result.wi = inFrame(shadingNormal_, std::sqrt(1 - a), phi);
    } else if (dirac_) {
        return sampleDirac(lobe);
    } else {
        const dvec3 h = inFrame(shadingNormal_, std::sqrt((1 - a) / (1 + (width_ * width_ - 1) * a)), phi);
        if (dot(wo_, h) <= 0) return result;
        if (lobe == Transmission && !thin_) {
            if (!refracted(wo_, h, eta_, result.wi)) return result;
        } else {
            result.wi = mirrored(wo_, h);
            if (lobe == Transmission) result.wi -= 2 * dot(result.wi, shadingNormal_) * shadingNormal_;
        }
        const bool below = dot(result.wi, shadingNormal_) < 0;
        if (below != (lobe == Transmission)) return result; // that facet sends light where its lobe has none
    }
    const double pdf = density(result.wi);
    if (pdf > 0) result.weight = evaluate(result.wi) * cosine(result.wi) / pdf;
    return result;
}

} // namespace support
