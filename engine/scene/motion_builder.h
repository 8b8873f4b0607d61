#pragma once
// Makes Scene::motion in code: nodes, meshes that stand at them, and one animation that repeats after a period.

#include <functional>
#include <memory>
#include <vector>

#include "engine/scene/motion.h"

namespace scene
{

class MotionBuilder
{
  public:
    // Parts and lights are appended to `scene`, which stays the caller's to add to. The animation has the scene's name.
    MotionBuilder(Scene& scene, double period); // seconds

    uint32_t addNode(const Transform& rest, uint32_t parent = NONE);

    // What shapes.h put into `shape`, in a space of its own; its materials do not matter. Parts may share it.
    uint32_t addMesh(const Scene& shape);

    // What weight 1 adds to a vertex at a position. The normals of such a mesh follow from its triangles.
    void addMorphTarget(uint32_t mesh, const std::function<glm::dvec3(const glm::dvec3& position)>& displacement);

    uint32_t addPart(uint32_t node, uint32_t mesh, uint32_t material, const glm::dmat4& nodeFromMesh = glm::dmat4(1));

    // The same of a mesh that is stored once, in its own material: it moves as the node does, which is not scaled.
    uint32_t storeMesh(const Scene& shape, uint32_t material); // its index
    void addInstance(uint32_t node, uint32_t storedMesh);

    // Joints take the part along, from where they and the part are at rest.
    void bind(uint32_t part, const std::vector<uint32_t>& joints,
              const std::function<std::vector<Influence>(const glm::dvec3& position)>& influences);

    // Shines along the node's -z, from its place.
    void addLight(uint32_t node, const PunctualLight& light);

    // Whole turns in a period, at an even speed, from the pose at rest.
    void turn(uint32_t node, const glm::dvec3& axis, int turns);

    // What a node has at `phase`, 0 to 1, of the period: periodic and smooth, met exactly at `steps` times. The pose at
    // rest is that of phase 0.
    template <class T>
    using At = std::function<T(double phase)>;
    void translate(uint32_t node, uint32_t steps, const At<glm::dvec3>& translation);
    void rotate(uint32_t node, uint32_t steps, const At<glm::dquat>& rotation);
    void morph(uint32_t node, uint32_t steps, const At<std::vector<double>>& weights);

    void finish(); // the scene has its motion, and is at rest

  private:
    using Numbers = std::vector<double>;
    Numbers addChannel(Property property, uint32_t node, uint32_t steps, Interpolation interpolation,
                       const At<Numbers>& value);  // what it is at 0 s
    glm::dmat4 worldFromNode(uint32_t node) const; // at rest

    Scene& scene_;
    std::shared_ptr<Motion> motion_ = std::make_shared<Motion>();
};

} // namespace scene
