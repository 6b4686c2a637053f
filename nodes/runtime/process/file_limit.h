#pragma once

namespace dmise {

/// Raises the limit of open files as far as the system permits, to at most 65,536: each connection
/// is one, and the usual soft limit is 1,024.
void raise_file_limit();

}  // namespace dmise
