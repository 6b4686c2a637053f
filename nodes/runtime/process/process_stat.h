#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace dmise {

/// What the kernel says of a process of this machine, proc(5): fields 3 (`state`) and after, as
/// text. Empty if there is no such process, or it is hidden.
std::vector<std::string> process_stat(pid_t pid);

/// 'R' running or waiting for a core, 'D' waiting for a disk, 'S' sleeping, 'T' stopped, 'Z' ended
/// and not yet waited for, and others of proc(5); '?' if nothing is said of it.
char process_state(pid_t pid);

}  // namespace dmise
