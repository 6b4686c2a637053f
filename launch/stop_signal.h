#pragma once

namespace dmise {

/// Turns SIGINT and SIGTERM into a flag; a second one ends the process at once.
void catch_stop_signals();
bool stop_requested();

}  // namespace dmise
