#pragma once

namespace dmise {

/// Lets this process open as many files as the system lets it, at most 65,536: each connection is
/// one, and the usual soft limit is 1,024.
void raise_file_limit();

}  // namespace dmise
