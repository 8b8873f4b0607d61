// Scattering at a surface: docs/LIGHT_TRANSPORT.md. Three lobes (diffuse, specular reflection, transmission),
// evaluated as one sum, sampled as one mixture. Directions are in the local frame of n_s unless named world.
#ifndef SHADERS_SCENE_BSDF_GLSL
#define SHADERS_SCENE_BSDF_GLSL

#include "lib/ggx.glsl"
#include "scene/surface.glsl"

const float DIRAC_ALPHA = 1.0 / 4096.0; // below: perfect mirror, perfect glass
const float LOBE_FLOOR = 0.04;          // of a lobe's pick weight, so that no lobe with f > 0 is ever unreachable

struct Bsdf {
    mat3 frame;           // columns: tangent, bitangent, n_s
    vec3 geometricNormal; // world, on w_o's side
    vec3 wo;
    vec3 baseColor;
    vec3 specularColor;
    vec3 dielectricF0; // F0d
    vec3 diffuse;      // f of the diffuse lobe but for q(cos i): rho / pi * ...
    float diffuseCoat; // share of the diffuse lobe that is under the specular coat
    float specular;
    float metallic;
    float alphaG;
    float transmission; // t = transmission (1 - m)
    float eta;          // index beyond over index here; of the material itself when thin
    bool exactFresnel;
    bool solid;
    bool dirac;        // the specular lobes are Dirac
    vec3 pick;         // probabilities of diffuse, specular reflection, transmission; sum 1, or 0 when all is absorbed
};

vec3 dielectricFresnel(Bsdf b, float c)
{
    if (HAS_TRANSMISSION && b.exactFresnel) return min(b.specular * b.specularColor * fresnelDielectric(c, b.eta), vec3(1.0));
    return b.specular * (b.dielectricF0 + (1.0 - b.dielectricF0) * schlickWeight(c));
}

vec3 specularFresnel(Bsdf b, float c)
{
    vec3 metal = b.baseColor + (1.0 - b.baseColor) * schlickWeight(c);
    return mix(dielectricFresnel(b, c), metal, b.metallic);
}

Bsdf makeBsdf(Surface s, vec3 woWorld)
{
    Bsdf b;
    b.frame = basisFromNormal(s.normal);
    b.geometricNormal = s.geometricNormal;
    b.wo = woWorld * b.frame;
    b.baseColor = s.baseColor;
    b.specularColor = s.specularColor;
    b.specular = s.specular;
    b.metallic = s.metallic;
    b.alphaG = s.alphaG;
    b.transmission = s.transmission * (1.0 - s.metallic);
    b.eta = s.eta;
    b.exactFresnel = (s.flags & MATERIAL_TRANSMISSIVE) != 0u;
    b.solid = HAS_SOLID && (s.flags & MATERIAL_SOLID) != 0u;
    b.dirac = HAS_DIRAC && (!HAS_ROUGH || s.alphaG < DIRAC_ALPHA);
    float r0 = (s.ior - 1.0) / (s.ior + 1.0);
    b.dielectricF0 = min(r0 * r0 * s.specularColor, vec3(1.0));

    float co = b.wo.z;
    vec3 rho = s.baseColor * ((1.0 - s.metallic) * (1.0 - s.transmission));
    b.diffuse = rho / PI;
    b.diffuseCoat = 0.0;
    b.pick = vec3(maxComponent(rho), 0.0, 0.0);
    if (HAS_SPECULAR) {
        // Under the coat: (22/21)(1 - F0max) q(cos o), and q(cos i) in evaluate(). See the model for the constant.
        b.diffuseCoat = s.specular * (22.0 / 21.0) * (1.0 - maxComponent(b.dielectricF0)) * (1.0 - schlickWeight(co));
        b.pick.x *= 1.0 - s.specular + b.diffuseCoat;
        float present = mix(s.specular, 1.0, s.metallic);
        b.pick.y = max(maxComponent(specularFresnel(b, co)), LOBE_FLOOR * present);
    }
    if (HAS_TRANSMISSION) {
        float through = 1.0 - min(dielectricFresnel(b, co).x, min(dielectricFresnel(b, co).y, dielectricFresnel(b, co).z));
        b.pick.z = b.transmission * maxComponent(s.baseColor) * max(through, b.dirac ? 0.0 : LOBE_FLOOR);
    }
    if (HAS_UNLIT && (s.flags & MATERIAL_UNLIT) != 0u) b.pick = vec3(0.0);
    float total = b.pick.x + b.pick.y + b.pick.z;
    b.pick = total > 0.0 && co > 0.0 ? b.pick / total : vec3(0.0);
    return b;
}

// About what part of light is scattered towards w_o.
vec3 albedoOf(Bsdf b)
{
    vec3 albedo = PI * b.diffuse;
    if (HAS_SPECULAR) albedo = albedo * (1.0 - b.specular + b.diffuseCoat) + specularFresnel(b, b.wo.z);
    if (HAS_TRANSMISSION) albedo += b.transmission * b.baseColor * (1.0 - dielectricFresnel(b, b.wo.z));
    return albedo;
}

bool absorbs(Bsdf b) { return b.pick == vec3(0.0); }

// f |cos i| of all lobes of finite width, and the mixture's solid-angle density of sampling wi.
vec3 evaluate(Bsdf b, vec3 wi, vec3 wiWorld, out float pdf)
{
    pdf = 0.0;
    float co = b.wo.z;
    float ci = abs(wi.z);
    float geometricSide = dot(b.geometricNormal, wiWorld);
    vec3 f = vec3(0.0);
    if (wi.z > 0.0) {
        vec3 reflected = b.diffuse;
        if (HAS_SPECULAR) reflected *= 1.0 - b.specular + b.diffuseCoat * (1.0 - schlickWeight(ci));
        pdf = b.pick.x * ci / PI;
        if (HAS_SPECULAR && HAS_ROUGH && !b.dirac) {
            vec3 h = normalize(b.wo + wi);
            float c = dot(b.wo, h);
            reflected += specularFresnel(b, c) * (0.25 * ggxDistribution(h, b.alphaG) * ggxShadowing(co, ci, b.alphaG));
            pdf += b.pick.y * 0.25 * ggxVisible(co, h, b.alphaG);
        }
        if (geometricSide > 0.0) f = reflected * ci;
    }
    if (HAS_TRANSMISSION && HAS_ROUGH && !b.dirac && wi.z < 0.0) {
        vec3 transmitted = b.transmission * b.baseColor;
        if (!b.solid) {
            vec3 h = normalize(b.wo + vec3(wi.xy, -wi.z));
            float c = dot(b.wo, h);
            transmitted *= (1.0 - dielectricFresnel(b, c)) *
                           (0.25 * ggxDistribution(h, b.alphaG) * ggxShadowing(co, ci, b.alphaG));
            pdf = b.pick.z * 0.25 * ggxVisible(co, h, b.alphaG);
        } else { // Walter et al. 2007, Eqs. 16, 17, 21, without the compression of radiance
            vec3 h = normalize(b.wo + b.eta * wi);
            if (h.z < 0.0) h = -h;
            float ho = dot(b.wo, h);
            float hi = dot(wi, h);
            float denominator = ho + b.eta * hi;
            bool refracts = ho > 0.0 && hi < 0.0;
            float jacobian = refracts ? b.eta * b.eta * -hi / (denominator * denominator) : 0.0; // |dh / dwi|
            transmitted *= (1.0 - dielectricFresnel(b, abs(ho))) *
                           (ggxDistribution(h, b.alphaG) * ggxShadowing(co, ci, b.alphaG) * abs(ho) * jacobian);
            pdf = b.pick.z * ggxVisible(co, h, b.alphaG) * abs(ho) * jacobian;
        }
        if (geometricSide < 0.0) f = transmitted * ci;
    }
    return f;
}

struct Scatter {
    vec3 direction; // world
    vec3 weight;    // f |cos i| / pdf; 0 when the path ends here
    float pdf;      // solid angle, of the mixture; unused when Dirac
    bool dirac;
};

// u.x picks the lobe, u.yz the direction.
Scatter sampleBsdf(Bsdf b, vec3 u)
{
    bool transmits = HAS_TRANSMISSION && u.x >= b.pick.x + b.pick.y && b.pick.z > 0.0;
    bool mirrors = HAS_SPECULAR && !transmits && u.x >= b.pick.x && b.pick.y > 0.0;
    vec3 wi = vec3(0.0);
    Scatter s = Scatter(vec3(0.0), vec3(0.0), 0.0, false);

    if (!HAS_ROUGH || (HAS_DIRAC && b.dirac)) {
        s.dirac = mirrors || transmits;
        if (mirrors) {
            wi = vec3(-b.wo.xy, b.wo.z);
            s.weight = specularFresnel(b, b.wo.z) / b.pick.y;
        }
        if (transmits) {
            float sin2 = (1.0 - b.wo.z * b.wo.z) / (b.eta * b.eta);
            wi = b.solid ? vec3(-b.wo.xy / b.eta, -sqrt(max(1.0 - sin2, 0.0))) : -b.wo;
            s.weight = b.transmission * b.baseColor * (1.0 - dielectricFresnel(b, b.wo.z)) / b.pick.z;
        }
    } else if (mirrors || transmits) {
        vec3 h = sampleVisibleNormal(b.wo, b.alphaG, u.yz);
        float c = dot(b.wo, h);
        wi = 2.0 * c * h - b.wo;
        if (transmits) {
            if (!b.solid) {
                wi.z = -wi.z;
            } else {
                float cos2 = 1.0 - (1.0 - c * c) / (b.eta * b.eta);
                wi = cos2 > 0.0 ? (c / b.eta - sqrt(max(cos2, 0.0))) * h - b.wo / b.eta : vec3(0.0);
            }
        }
        // A sample on the wrong side of n_s carries nothing.
        if (transmits ? wi.z >= 0.0 : wi.z <= 0.0) wi = vec3(0.0);
    }
    if (!transmits && !mirrors) wi = sampleCosineHemisphere(u.yz);

    if (wi == vec3(0.0)) return s;
    wi = normalize(wi);
    s.direction = normalize(b.frame * wi);
    if (s.dirac) {
        // Same geometric rule as evaluate().
        float side = dot(b.geometricNormal, s.direction);
        if (transmits ? side >= 0.0 : side <= 0.0) s.weight = vec3(0.0);
        return s;
    }
    vec3 f = evaluate(b, wi, s.direction, s.pdf);
    s.weight = s.pdf > 0.0 ? f / s.pdf : vec3(0.0);
    return s;
}

#endif
