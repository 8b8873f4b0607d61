// TEMPORARY brute force, so that everything builds until the real builder lands: replace this file whole.
#include "engine/scene/bvh.h"
#include <bit>
namespace scene {
Bvh buildBvh(const BvhInput& in, uint64_t) { Bvh b; b.nodes.push_back(glm::uvec4(in.triangles.size(),0,0,0));
 for (size_t t=0;t<in.triangles.size();++t) for (size_t i=0;i<3;++i){auto p=in.positions[in.triangles[t].vertices[i]]; b.triangles.push_back({std::bit_cast<uint32_t>(p.x),std::bit_cast<uint32_t>(p.y),std::bit_cast<uint32_t>(p.z), in.needsAlphaTest.empty()?0u:in.needsAlphaTest[t]});}
 return b; }
}
