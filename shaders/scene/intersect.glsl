// TEMPORARY brute force, so that everything builds until the real traversal lands: replace this file whole.
struct Ray { vec3 origin; vec3 direction; float tMax; };
struct Hit { uint triangle; vec2 barycentric; float t; };
const uint NO_HIT=0xffffffffu; const float RAY_MAX=1e30;
#include "scene/surface.glsl"
Hit closestHit(Ray r, uint alphaSeed){
 Hit h=Hit(NO_HIT, vec2(0), r.tMax);
 uint n=FETCH(Nodes,0).x;
 for(uint i=0u;i<n;++i){ vec3 p0=uintBitsToFloat(FETCH(Triangles,i*3u).xyz),p1=uintBitsToFloat(FETCH(Triangles,i*3u+1u).xyz),p2=uintBitsToFloat(FETCH(Triangles,i*3u+2u).xyz);
  vec3 e1=p1-p0,e2=p2-p0; vec3 p=cross(r.direction,e2); float d=dot(e1,p); if(d==0.0) continue; float inv=1.0/d; vec3 s=r.origin-p0; float u=dot(s,p)*inv; vec3 q=cross(s,e1); float v=dot(r.direction,q)*inv; float t=dot(e2,q)*inv;
  if(u>=0.0&&v>=0.0&&u+v<=1.0&&t>0.0&&t<h.t && (!HAS_ALPHA || FETCH(Triangles,i*3u).w==0u || alphaPasses(i,vec2(u,v),alphaSeed))){h=Hit(i,vec2(u,v),t);} }
 return h;}
bool occluded(Ray r, uint a){return closestHit(r,a).triangle!=NO_HIT;}
vec3 offsetOrigin(vec3 p, vec3 n, vec3 d){return p+n*(dot(n,d)>0.0?1.0:-1.0)*1e-5;}
