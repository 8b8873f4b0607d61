#include "engine/scene/gltf_motion.h"

#include <algorithm>

#include "engine/base/error.h"

namespace scene::gltf
{

namespace
{

bool isOf(const Channel& channel, Owner owner)
{
    return factsOf(channel.property).owner == owner;
}

// Nodes whose place in the world, or visibility, changes at some time; or whose visibility would, if its animation were
// not broken: they are not hidden for good, so a pose must hide them.
std::vector<bool> movingNodes(const Motion& motion, const Document& document, const NodeTree& tree)
{
    std::vector<bool> moving(tree.parents.size(), false);
    for (const auto& [property, node] : document.animations.moved)
        if (property == Property::Visible) moving[node] = true;
    for (const Animation& animation : motion.animations) {
        for (const Channel& channel : animation.channels) {
            if (isOf(channel, Owner::Node) && channel.property != Property::Weights) moving[channel.object] = true;
        }
    }
    for (const uint32_t i : tree.order) {
        if (tree.parents[i] != NONE && moving[tree.parents[i]]) moving[i] = true;
    }
    return moving;
}

// Each channel counts objects of the file; `newIndex` says where they are in Motion. Those of objects that are nowhere
// go.
template <class NewIndex>
void renumber(Motion& motion, Owner owner, NewIndex&& newIndex)
{
    for (Animation& animation : motion.animations) {
        for (Channel& channel : animation.channels) {
            if (isOf(channel, owner)) channel.object = newIndex(channel.object);
        }
        std::erase_if(animation.channels, [&](const Channel& c) { return isOf(c, owner) && c.object == NONE; });
    }
}

void addNodes(MotionPlan& plan, const Document& document, const NodeTree& tree, const std::vector<bool>& needed)
{
    Warnings said; // by resolveNodes
    for (const uint32_t i : tree.order) {
        if (!needed[i]) continue;
        const tinygltf::Node& source = document.model.nodes[i];
        const uint32_t parent = tree.parents[i];
        Motion::Node node{.parent = parent == NONE ? NONE : plan.nodeOf[parent],
                          .rest = readTransform(source, i, said),
                          .visible = isVisible(source),
                          .weights = source.weights};
        if (node.parent == NONE && parent != NONE) node.worldFromParent = tree.worldFromNode[parent];
        if (node.weights.empty() && source.mesh >= 0)
            node.weights = document.model.meshes[static_cast<size_t>(source.mesh)].weights;
        plan.nodeOf[i] = static_cast<uint32_t>(plan.motion->nodes.size());
        plan.motion->nodes.push_back(std::move(node));
    }
}

void addSkins(MotionPlan& plan, const Document& document, const std::vector<bool>& needed, MeshPartReader& reader)
{
    for (size_t s = 0; s < needed.size(); ++s) {
        if (!needed[s]) continue;
        plan.skinOf[s] = static_cast<uint32_t>(plan.motion->skins.size());
        const tinygltf::Skin& source = document.model.skins[s];
        Motion::Skin& skin = plan.motion->skins.emplace_back();
        for (size_t i = 0; i < source.joints.size(); ++i) {
            skin.joints.push_back(plan.nodeOf[static_cast<size_t>(source.joints[i])]);
            skin.inverseBindings.push_back(
                source.inverseBindMatrices < 0 ? glm::dmat4(1) : reader.accessor(source.inverseBindMatrices).mat4(i));
        }
    }
}

} // namespace

MotionPlan planMotion(const Document& document, const NodeTree& tree, MeshPartReader& reader, Warnings& warnings)
{
    MotionPlan plan;
    if (document.animations.animations.empty()) return plan;
    plan.motion = std::make_shared<Motion>();
    plan.motion->animations = readAnimations(document, plan.motion->numbers, warnings);

    const auto& nodes = document.model.nodes;
    const std::vector<bool> moving = movingNodes(*plan.motion, document, tree);
    std::vector<bool> movesWeights(nodes.size(), false);
    for (const Animation& animation : plan.motion->animations) {
        for (const Channel& channel : animation.channels)
            if (channel.property == Property::Weights) movesWeights[channel.object] = true;
    }
    std::vector<bool> movingSkins;
    for (const tinygltf::Skin& skin : document.model.skins)
        movingSkins.push_back(
            std::ranges::any_of(skin.joints, [&](int joint) { return moving[static_cast<size_t>(joint)]; }));

    plan.nodeOf.assign(nodes.size(), NONE);
    plan.skinOf.assign(movingSkins.size(), NONE);
    plan.movesMesh.assign(nodes.size(), false);
    std::vector<bool> needed = moving, neededSkins(movingSkins.size(), false);
    for (const uint32_t i : tree.visible) {
        if (nodes[i].mesh < 0 || tree.hidden[i]) continue;
        const bool skinned = nodes[i].skin >= 0;
        const auto skin = static_cast<size_t>(std::max(nodes[i].skin, 0));
        if (!moving[i] && !movesWeights[i] && !(skinned && movingSkins[skin])) continue;
        plan.movesMesh[i] = needed[i] = true;
        if (skinned) neededSkins[skin] = true;
    }
    for (size_t s = 0; s < neededSkins.size(); ++s) {
        for (const int joint : document.model.skins[s].joints)
            if (neededSkins[s]) needed[static_cast<size_t>(joint)] = true;
    }
    addNodes(plan, document, tree, needed);
    addSkins(plan, document, neededSkins, reader);
    renumber(*plan.motion, Owner::Node, [&](uint32_t node) { return plan.nodeOf[node]; });
    return plan;
}

MeshPart addPart(MotionPlan& plan, const Document& document, MeshPartReader& reader, size_t primitiveIndex,
                 uint32_t nodeIndex, const Placement& placement, Motion::Part part, const Material& material)
{
    Motion& motion = *plan.motion;
    const tinygltf::Node& node = document.model.nodes[nodeIndex];
    const std::string where = part.name;
    const auto [mesh, isNew] = plan.meshOf.try_emplace({node.mesh, primitiveIndex, placement.worldFromSkin.size()},
                                                       static_cast<uint32_t>(motion.meshes.size()));
    if (isNew)
        motion.meshes.push_back(
            reader.readMesh(document.model.meshes[static_cast<size_t>(node.mesh)].primitives[primitiveIndex], where,
                            placement.worldFromSkin.size(), material));
    part.name += fmt::format(" at nodes[{}]", nodeIndex);
    part.node = plan.nodeOf[nodeIndex];
    part.mesh = mesh->second;
    if (node.skin >= 0) part.skin = plan.skinOf[static_cast<size_t>(node.skin)];
    motion.parts.push_back(std::move(part));
    return reader.place(motion.meshes[mesh->second], where, placement, material);
}

void completeMotion(MotionPlan& plan, const Document& document, const std::vector<WorldCamera>& cameras,
                    const std::vector<WorldLight>& lights, const std::vector<uint32_t>& materialOf, Scene& scene)
{
    Motion& motion = *plan.motion;
    const std::set<std::pair<Property, uint32_t>>& moved = document.animations.moved;
    const auto movesAny = [&](Owner owner, uint32_t object) {
        return std::ranges::any_of(PROPERTIES, [&](const PropertyFacts& facts) {
            return facts.owner == owner && moved.contains({facts.property, object});
        });
    };
    std::map<uint32_t, uint32_t> lampOf, lensOf, paintOf; // by object of the file
    const auto indexOf = [](std::map<uint32_t, uint32_t>& known, uint32_t source, auto& list, const auto& entry) {
        const auto [found, isNew] = known.try_emplace(source, static_cast<uint32_t>(list.size()));
        if (isNew) list.push_back(entry);
        return found->second;
    };
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const uint32_t node = plan.nodeOf[lights[i].node];
        if (node != NONE || movesAny(Owner::Light, lights[i].source))
            motion.lights.push_back({i, node, indexOf(lampOf, lights[i].source, motion.lamps, lights[i].lamp)});
    }
    for (uint32_t i = 0; i < cameras.size(); ++i) {
        const uint32_t node = plan.nodeOf[cameras[i].node];
        const auto source = static_cast<uint32_t>(document.model.nodes[cameras[i].node].camera);
        const Camera& rest = scene.cameras[i];
        if (node != NONE || movesAny(Owner::Camera, source))
            motion.cameras.push_back(
                {i, node, indexOf(lensOf, source, motion.lenses, Motion::Lens{rest.yfov, rest.xmag, rest.ymag}), rest});
    }
    for (uint32_t i = 0; i < materialOf.size(); ++i) {
        if (materialOf[i] == NONE || !movesAny(Owner::Material, i)) continue;
        const Material& rest = scene.materials[materialOf[i]];
        const auto emission = document.animations.emissions.find(i);
        Motion::Paint paint{.material = materialOf[i],
                            .baseColor = rest.baseColor,
                            .metallic = rest.metallic,
                            .roughness = rest.roughness,
                            .emissiveFactor = rest.emission};
        if (emission != document.animations.emissions.end()) {
            paint.emissiveFactor = emission->second.factor;
            paint.emissiveStrength = emission->second.strength;
        }
        indexOf(paintOf, i, motion.paints, paint);
    }
    const auto renumberBy = [&](Owner owner, const std::map<uint32_t, uint32_t>& known) {
        renumber(motion, owner, [&](uint32_t object) {
            const auto found = known.find(object);
            return found == known.end() ? NONE : found->second;
        });
    };
    renumberBy(Owner::Light, lampOf);
    renumberBy(Owner::Camera, lensOf);
    renumberBy(Owner::Material, paintOf);
    scene.motion = plan.motion;
}

} // namespace scene::gltf
