#pragma once
#include <string>

namespace dmise {

/// A shared object that is loaded when it is first needed.
struct Module {
  const char* name;         // NAME of libdmise_NAME.so, in a lib above this code's file
  const char* environment;  // names another file
};

/// Loads the module at the first call and returns the object that its function `entry`, of type
/// `T*(std::string& reason)`, makes; the caller owns it. Throws `Error` "NAME: reason" if it cannot
/// be loaded or made.
void* made_by_module(const Module& module, const char* entry);

}  // namespace dmise
