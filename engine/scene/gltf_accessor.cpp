#include "engine/scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/scene/gltf_json_checks.h"

namespace scene::gltf
{

namespace
{

template <class T>
T load(const std::byte* from)
{
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

uint32_t loadUnsigned(const std::byte* from, uint32_t size)
{
    if (size == 1) return load<uint8_t>(from);
    return size == 2 ? load<uint16_t>(from) : load<uint32_t>(from);
}

} // namespace

Accessor::Accessor(const Document& document, int index)
{
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    count_ = accessor.count;
    components_ = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    componentType_ = accessor.componentType;
    normalized_ = accessor.normalized;
    componentSize_ = componentSize(static_cast<uint64_t>(componentType_));
    if (accessor.bufferView >= 0) {
        const size_t stride = document.model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
        stride_ = stride != 0 ? stride : size_t{componentSize_} * components_;
        base_ = document.view(accessor.bufferView).subspan(accessor.byteOffset);
    }
    if (!accessor.sparse.isSparse) return;

    const auto& sparse = accessor.sparse;
    const auto indices =
        document.view(sparse.indices.bufferView).subspan(static_cast<size_t>(sparse.indices.byteOffset));
    const uint32_t size = componentSize(static_cast<uint64_t>(sparse.indices.componentType));
    sparseIndices_.resize(static_cast<size_t>(sparse.count));
    for (size_t i = 0; i < sparseIndices_.size(); ++i) {
        sparseIndices_[i] = loadUnsigned(&indices[i * size], size);
        if (sparseIndices_[i] >= count_)
            throw Error("accessors[{}].sparse.indices has {} at {}, but there are {} elements.", index,
                        sparseIndices_[i], i, count_);
        if (i > 0 && sparseIndices_[i] <= sparseIndices_[i - 1])
            throw Error("accessors[{}].sparse.indices does not increase at {} ({} after {}).", index, i,
                        sparseIndices_[i], sparseIndices_[i - 1]);
    }
    sparseValues_ = document.view(sparse.values.bufferView).subspan(static_cast<size_t>(sparse.values.byteOffset));
}

const std::byte* Accessor::at(size_t element, uint32_t component) const
{
    CHECK_LT(element, count_);
    CHECK_LT(component, components_);
    if (!sparseIndices_.empty()) {
        const auto found = std::lower_bound(sparseIndices_.begin(), sparseIndices_.end(), element);
        if (found != sparseIndices_.end() && *found == element) {
            const auto i = static_cast<size_t>(found - sparseIndices_.begin());
            return &sparseValues_[(i * components_ + component) * componentSize_];
        }
    }
    return base_.empty() ? nullptr : &base_[element * stride_ + size_t{component} * componentSize_];
}

double Accessor::number(size_t element, uint32_t component) const
{
    const std::byte* from = at(element, component);
    if (!from) return 0;
    const auto scaled = [&](double value, double full) { return normalized_ ? std::max(value / full, -1.0) : value; };
    switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(load<int8_t>(from), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled(load<uint8_t>(from), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled(load<int16_t>(from), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled(load<uint16_t>(from), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return scaled(load<uint32_t>(from), 4294967295.0);
    default: return load<float>(from);
    }
}

uint32_t Accessor::integer(size_t element, uint32_t component) const
{
    const std::byte* from = at(element, component);
    return from ? loadUnsigned(from, componentSize_) : 0;
}

glm::dmat4 Accessor::mat4(size_t element) const
{
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = number(element, static_cast<uint32_t>(i));
    return matrix;
}

} // namespace scene::gltf
