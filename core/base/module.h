#pragma once
#include <string>

namespace dmise {

/// A part of the program that costs nothing until it is asked for.
struct Module {
  const char* name;         // of the shared object: lib/libdmise_NAME.so beside the programs' bin
  const char* environment;  // names another file
};

/// Loads the module at its first entry and returns what `entry`, a function `T*(std::string&
/// reason)`, makes: the caller's. Throws `Error` "NAME: reason" when it cannot be had.
void* made_by_module(const Module& module, const char* entry);

}  // namespace dmise
