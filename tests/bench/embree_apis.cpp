#include "tests/bench/embree_apis.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>

#include <immintrin.h>

namespace
{

constexpr size_t BLOCK = 1024; // rays that a thread takes at a time, a multiple of every packet

void forBlocks(size_t count, unsigned threads, const std::function<void(size_t, size_t)>& trace)
{
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        _mm_setcsr(_mm_getcsr() | 0x8040); // flush denormals, as Embree's manual asks
        for (size_t begin; (begin = next.fetch_add(BLOCK)) < count;) trace(begin, std::min(begin + BLOCK, count));
    };
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    std::jthread(work).join();
}

// An occluded ray has tfar of minus infinity; a closest hit has a primitive.
bool isHit(float tfar, uint32_t primitive, bool anyHit)
{
    return anyHit ? tfar < 0 : primitive != RTC_INVALID_GEOMETRY_ID;
}

EmbreeApi oneByOne(RTCScene scene, const std::vector<TestRay>& rays, bool anyHit, unsigned threads)
{
    auto queries = std::make_shared<std::vector<RTCRayHit>>(rays.size());
    return {.name = "rtcIntersect1",
            .prepare = [&rays, queries] { std::ranges::transform(rays, queries->begin(), embreeRay); },
            .run =
                [=] {
                    forBlocks(queries->size(), threads, [&](size_t begin, size_t end) {
                        RTCIntersectContext context;
                        rtcInitIntersectContext(&context);
                        for (size_t i = begin; i < end; ++i)
                            if (anyHit)
                                rtcOccluded1(scene, &context, &(*queries)[i].ray);
                            else
                                rtcIntersect1(scene, &context, &(*queries)[i]);
                    });
                },
            .hits =
                [=] {
                    return size_t(std::ranges::count_if(
                        *queries, [&](const RTCRayHit& q) { return isHit(q.ray.tfar, q.hit.primID, anyHit); }));
                }};
}

EmbreeApi stream(RTCScene scene, const std::vector<TestRay>& rays, bool anyHit, unsigned threads, bool coherent)
{
    EmbreeApi api = oneByOne(scene, rays, anyHit, threads);
    auto queries = std::make_shared<std::vector<RTCRayHit>>(rays.size());
    api.name = coherent ? "rtcIntersect1M, coherent" : "rtcIntersect1M";
    api.prepare = [&rays, queries] { std::ranges::transform(rays, queries->begin(), embreeRay); };
    api.run = [=] {
        forBlocks(queries->size(), threads, [&](size_t begin, size_t end) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
            RTCRayHit& first = (*queries)[begin];
            const auto count = unsigned(end - begin);
            if (anyHit)
                rtcOccluded1M(scene, &context, &first.ray, count, sizeof(RTCRayHit));
            else
                rtcIntersect1M(scene, &context, &first, count, sizeof(RTCRayHit));
        });
    };
    api.hits = [=] {
        return size_t(std::ranges::count_if(
            *queries, [&](const RTCRayHit& q) { return isHit(q.ray.tfar, q.hit.primID, anyHit); }));
    };
    return api;
}

// Packets of WIDTH rays. `Packet` is RTCRayHitN, `trace` calls Embree with (valid, scene, context, packet).
template <size_t WIDTH, class Packet, class Trace>
EmbreeApi packets(const std::vector<TestRay>& rays, bool anyHit, unsigned threads, Trace trace)
{
    struct Shared {
        std::vector<Packet> packets;
        std::vector<std::array<int, WIDTH>> valid; // -1: the lane holds a ray
    };
    const size_t count = (rays.size() + WIDTH - 1) / WIDTH;
    auto shared = std::make_shared<Shared>();
    shared->packets.resize(count);
    shared->valid.resize(count);
    EmbreeApi api;
    api.name = "rtcIntersect" + std::to_string(WIDTH);
    api.prepare = [&rays, shared] {
        for (size_t i = 0; i < shared->packets.size() * WIDTH; ++i) {
            const size_t lane = i % WIDTH;
            const RTCRayHit one = embreeRay(rays[std::min(i, rays.size() - 1)]);
            Packet& packet = shared->packets[i / WIDTH];
            shared->valid[i / WIDTH][lane] = i < rays.size() ? -1 : 0;
            packet.ray.org_x[lane] = one.ray.org_x;
            packet.ray.org_y[lane] = one.ray.org_y;
            packet.ray.org_z[lane] = one.ray.org_z;
            packet.ray.dir_x[lane] = one.ray.dir_x;
            packet.ray.dir_y[lane] = one.ray.dir_y;
            packet.ray.dir_z[lane] = one.ray.dir_z;
            packet.ray.tnear[lane] = 0;
            packet.ray.tfar[lane] = one.ray.tfar;
            packet.ray.time[lane] = 0;
            packet.ray.mask[lane] = one.ray.mask;
            packet.ray.flags[lane] = 0;
            packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
    };
    api.run = [=, total = rays.size()] {
        forBlocks(total, threads, [&](size_t begin, size_t end) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            for (size_t i = begin / WIDTH; i < (end + WIDTH - 1) / WIDTH; ++i) {
                alignas(64) const std::array<int, WIDTH> valid = shared->valid[i];
                trace(valid.data(), &context, shared->packets[i]);
            }
        });
    };
    api.hits = [=, total = rays.size()] {
        size_t hits = 0;
        for (size_t i = 0; i < total; ++i) {
            const Packet& packet = shared->packets[i / WIDTH];
            hits += isHit(packet.ray.tfar[i % WIDTH], packet.hit.primID[i % WIDTH], anyHit) ? 1 : 0;
        }
        return hits;
    };
    return api;
}

} // namespace

std::vector<EmbreeApi> embreeApis(const EmbreeScene& embree, const std::vector<TestRay>& rays, bool anyHit,
                                  unsigned threads)
{
    RTCScene scene = embree.handle();
    std::vector<EmbreeApi> apis;
    apis.push_back(oneByOne(scene, rays, anyHit, threads));
    apis.push_back(
        packets<4, RTCRayHit4>(rays, anyHit, threads, [=](const int* v, RTCIntersectContext* c, RTCRayHit4& p) {
            anyHit ? rtcOccluded4(v, scene, c, &p.ray) : rtcIntersect4(v, scene, c, &p);
        }));
    apis.push_back(
        packets<8, RTCRayHit8>(rays, anyHit, threads, [=](const int* v, RTCIntersectContext* c, RTCRayHit8& p) {
            anyHit ? rtcOccluded8(v, scene, c, &p.ray) : rtcIntersect8(v, scene, c, &p);
        }));
    apis.push_back(
        packets<16, RTCRayHit16>(rays, anyHit, threads, [=](const int* v, RTCIntersectContext* c, RTCRayHit16& p) {
            anyHit ? rtcOccluded16(v, scene, c, &p.ray) : rtcIntersect16(v, scene, c, &p);
        }));
    apis.push_back(stream(scene, rays, anyHit, threads, false));
    apis.push_back(stream(scene, rays, anyHit, threads, true));
    if (anyHit)
        for (EmbreeApi& api : apis) api.name.replace(0, std::string("rtcIntersect").size(), "rtcOccluded");
    return apis;
}
