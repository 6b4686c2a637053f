#include "launch/frames/frame_options.h"

#include <CLI/CLI.hpp>
#include <vector>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "launch/command/notes.h"

namespace dmise {

void add_frame_options(CLI::App& command, const std::shared_ptr<FrameChoice>& choice) {
  command
      .add_option_function<int>(
          "--plane", [choice](const int& plane) { choice->plane = plane; },
          "plane of another camera's cube or colour frame, from 1")
      ->check(CLI::Range(1, 1 << 20));
  command.add_option_function<std::vector<std::string>>(
      "--set",
      [choice](const std::vector<std::string>& pairs) {
        for (const std::string& pair : pairs) {
          const std::size_t at = pair.find('=');
          const std::string key = pair.substr(0, at);
          if (at == std::string::npos || key.empty() || key.size() > 8 ||
              key.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") != key.npos)
            throw ConfigError("--set: must be KEYWORD=VALUE, got " + printable(pair, 80));
          if (!choice->stated.emplace(key, pair.substr(at + 1)).second)
            throw ConfigError("--set: " + key + ": is stated twice");
        }
      },
      "KEYWORD=VALUE that another camera's header lacks or has wrong, such as EGAIN=0.5; "
      "repeatable");
}

void print_notes(const std::string& path, const FrameNotes& notes) {
  for (const std::string& text : notes.missing) print_note(path + ": missing: " + text);
  for (const std::string& text : notes.assumed) print_note(path + ": assumed: " + text);
}

}  // namespace dmise
