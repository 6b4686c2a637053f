#pragma once
#include <functional>
#include <string>

namespace dmise {

/// Announces the address of a process: writes it to `file` unless that is empty, as one line to
/// `descriptor` unless that is negative, and calls `on_bound` if there is one. Throws `Error`.
void announce(const std::string& address, const std::string& file, int descriptor,
              const std::function<void(const std::string& address)>& on_bound);

}  // namespace dmise
