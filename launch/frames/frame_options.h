#pragma once
#include <memory>
#include <string>

#include "core/ingest/any_frame.h"

namespace CLI {
class App;
}

namespace dmise {

/// Adds --plane and --set to a command that reads frames; `choice` is filled when it is parsed.
void add_frame_options(CLI::App& command, const std::shared_ptr<FrameChoice>& choice);

/// Writes a frame's notes to standard error, one a line: "note: PATH: missing: ..." and "note:
/// PATH: assumed: ...".
void print_notes(const std::string& path, const FrameNotes& notes);

}  // namespace dmise
