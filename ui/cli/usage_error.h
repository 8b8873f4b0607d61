#pragma once
// The command line is wrong: exit code 2 instead of Error's 1.

#include "engine/base/error.h"

namespace ui
{

class UsageError : public Error
{
  public:
    using Error::Error;
};

} // namespace ui
