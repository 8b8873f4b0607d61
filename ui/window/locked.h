#pragma once
// Looking at what another thread changes.

#include <mutex>

namespace ui
{

// As it is now; `mutex` guards it.
template <class Value>
Value copyOf(const Value& value, std::mutex& mutex)
{
    const std::lock_guard lock(mutex);
    return value;
}

} // namespace ui
