#pragma once
// Reads JSON with every type, range and index checked. Messages name the value by its path: accessors[3].sparse.count.

#include <cstdint>
#include <optional>
#include <string>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/shown.h"

namespace scene::gltf
{

using Json = nlohmann::json;

// A JSON object and where it stands. A child refers to its parent: live on the stack only.
class Object
{
  public:
    // The whole document. Throws Error when it is no object.
    explicit Object(const Json& document);

    bool has(const char* key) const { return json_->contains(key); }
    std::string path(const std::string& key = {}) const;

    // Absent members give nullopt; members of another type or out of range throw Error.
    std::optional<uint64_t> integer(const std::string& key, uint64_t minimum, uint64_t maximum) const;
    std::optional<double> number(const std::string& key) const;
    const std::string* string(const std::string& key) const;
    std::optional<bool> boolean(const std::string& key) const;
    void numbers(const std::string& key, size_t count) const; // an array of so many numbers; 0: of any length
    template <int COUNT>
    std::optional<glm::vec<COUNT, double>> vector(const std::string& key) const // an array of exactly so many
    {
        numbers(key, COUNT);
        const Json* values = find(key);
        if (!values) return std::nullopt;
        glm::vec<COUNT, double> result;
        for (int i = 0; i < COUNT; ++i) result[i] = (*values)[size_t(i)].template get<double>();
        return result;
    }
    // An index into an array of `count` entries, called `plural` in messages.
    std::optional<uint32_t> index(const std::string& key, size_t count, const char* plural) const;
    // ... into a top-level array of that name.
    std::optional<uint32_t> index(const std::string& key, const char* collection) const;

    template <class Value>
    Value required(const std::string& key, std::optional<Value> value) const
    {
        if (!value) throw Error("{} lacks \"{}\".", path(), key);
        return *value;
    }

    size_t arraySize(const std::string& key) const; // 0 when absent
    size_t collectionSize(const char* collection) const { return root_->arraySize(collection); }

    // Calls visit(Object) when there is such a member.
    template <class Visit>
    void object(const std::string& key, Visit&& visit) const
    {
        if (const Json* member = find(key)) visit(Object(this, key, NO_INDEX, *member));
    }
    // The same of an extension.
    template <class Visit>
    void extension(const std::string& name, Visit&& visit) const
    {
        object("extensions", [&](const Object& extensions) { extensions.object(name, visit); });
    }
    template <class Visit>
    void requiredObject(const std::string& key, Visit&& visit) const
    {
        if (!json_->contains(key)) throw Error("{} lacks \"{}\".", path(), key);
        object(key, visit);
    }
    // Calls visit(Object, index) for each entry of an array of objects.
    template <class Visit>
    void eachObject(const std::string& key, Visit&& visit) const
    {
        for (size_t i = 0, count = arraySize(key); i < count; ++i) visit(Object(this, key, i, (*find(key))[i]), i);
    }
    // One entry of an array of objects.
    Object at(const char* key, size_t i) const { return Object(this, key, i, (*find(key))[i]); }

    // Calls visit(index) for each entry of an array of indices into a top-level array.
    template <class Visit>
    void eachIndex(const std::string& key, const char* collection, Visit&& visit) const
    {
        for (size_t i = 0, count = arraySize(key); i < count; ++i)
            visit(asIndex((*find(key))[i], path(key) + "[" + std::to_string(i) + "]", collectionSize(collection),
                          collection));
    }

    const Json& json() const { return *json_; }
    const Object& root() const { return *root_; }

  private:
    static constexpr size_t NO_INDEX = ~size_t{0};

    Object(const Object* parent, std::string key, size_t index, const Json& json);
    const Json* find(const std::string& key) const;
    static uint32_t asIndex(const Json& value, const std::string& path, size_t count, const char* plural);

    const Object* root_;
    const Object* parent_ = nullptr;
    std::string key_;
    size_t index_ = NO_INDEX;
    const Json* json_;
};

} // namespace scene::gltf
