#include "engine/scene/gltf_json.h"

#include <limits>

namespace scene::gltf
{

namespace
{

std::string shown(const Json& value)
{
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("an array of {}", value.size());
    if (value.is_string()) return fmt::format("\"{}\"", ::shown(value.get_ref<const std::string&>()));
    return value.dump();
}

} // namespace

Object::Object(const Json& document) : root_(this), json_(&document)
{
    if (!document.is_object()) throw Error("The JSON document is {}, not an object.", shown(document));
}

Object::Object(const Object* parent, std::string key, size_t index, const Json& json)
    : root_(parent->root_), parent_(parent), key_(std::move(key)), index_(index), json_(&json)
{
    if (!json.is_object()) throw Error("{} is {}, not an object.", path(), shown(json));
}

std::string Object::path(const std::string& key) const
{
    std::string result = parent_ ? parent_->path(key_) : std::string();
    if (index_ != NO_INDEX) result += fmt::format("[{}]", index_);
    if (key.empty()) return result.empty() ? "The JSON document" : result;
    return result.empty() ? ::shown(key) : result + "." + ::shown(key);
}

const Json* Object::find(const std::string& key) const
{
    const auto found = json_->find(key);
    return found == json_->end() ? nullptr : &*found;
}

std::optional<uint64_t> Object::integer(const std::string& key, uint64_t minimum, uint64_t maximum) const
{
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_number_unsigned() || value->get<uint64_t>() < minimum || value->get<uint64_t>() > maximum)
        throw Error("{} is {}, not an integer from {} to {}.", path(key), shown(*value), minimum, maximum);
    return value->get<uint64_t>();
}

std::optional<double> Object::number(const std::string& key) const
{
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_number()) throw Error("{} is {}, not a number.", path(key), shown(*value));
    return value->get<double>();
}

const std::string* Object::string(const std::string& key) const
{
    const Json* value = find(key);
    if (!value) return nullptr;
    if (!value->is_string()) throw Error("{} is {}, not a string.", path(key), shown(*value));
    return &value->get_ref<const std::string&>();
}

std::optional<bool> Object::boolean(const std::string& key) const
{
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_boolean()) throw Error("{} is {}, not true or false.", path(key), shown(*value));
    return value->get<bool>();
}

void Object::numbers(const std::string& key, size_t count) const
{
    const size_t size = arraySize(key);
    const Json* value = find(key);
    if (!value) return;
    if (count != 0 && size != count) throw Error("{} has {} elements instead of {}.", path(key), size, count);
    for (size_t i = 0; i < size; ++i) {
        if (!(*value)[i].is_number()) throw Error("{}[{}] is {}, not a number.", path(key), i, shown((*value)[i]));
    }
}

uint32_t Object::asIndex(const Json& value, const std::string& path, size_t count, const char* plural)
{
    if (!value.is_number_unsigned()) throw Error("{} is {}, not an index.", path, shown(value));
    if (value.get<uint64_t>() >= count)
        throw Error("{} is {}, but the file has {} {}.", path, value.get<uint64_t>(), count, plural);
    return static_cast<uint32_t>(value.get<uint64_t>());
}

std::optional<uint32_t> Object::index(const std::string& key, size_t count, const char* plural) const
{
    const Json* value = find(key);
    if (!value) return std::nullopt;
    return asIndex(*value, path(key), count, plural);
}

std::optional<uint32_t> Object::index(const std::string& key, const char* collection) const
{
    return index(key, collectionSize(collection), collection);
}

size_t Object::arraySize(const std::string& key) const
{
    const Json* value = find(key);
    if (!value) return 0;
    if (!value->is_array()) throw Error("{} is {}, not an array.", path(key), shown(*value));
    return value->size();
}

} // namespace scene::gltf
