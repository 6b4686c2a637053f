#pragma once
#include <string>

namespace dmise {

/// Path of the file that this code was loaded from: the running program, or a shared object such as
/// a module of Python.
std::string own_file();

}  // namespace dmise
