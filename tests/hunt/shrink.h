#pragma once
// From a case that fails to the smallest one that still does: what can be taken away is.

#include <functional>

#include "tests/hunt/case.h"

namespace hunt
{

// `fails` is asked of smaller and smaller cases until nothing can go, or `stop` says so.
Case shrink(Case c, const std::function<bool(const Case&)>& fails, const std::function<bool()>& stop);

} // namespace hunt
