#pragma once
#include <optional>
#include <string>
#include <vector>

namespace dmise {

/// Options of the gateway that shows a run.
struct ViewOptions {
  std::string master;                  // address of the time-master
  std::string products;                // directory of the run; empty: no previews of frames
  std::string keys;                    // directory of keys; empty: none
  std::string tokens;                  // file of tokens; empty: none
  std::string listen = "127.0.0.1:0";  // address of the pages
  std::string announce;                // file for the URL; empty: none
  double answer_within_s = 0.0;        // the time-master's first; 0: it is waited for
  bool no_control = false;
  bool truth = false;
};

/// Command line of the gateway.
std::vector<std::string> gateway_command(const ViewOptions& options);

/// Writes a file of new tokens that only this user may read, and returns the operator's.
std::string make_view_tokens(const std::string& path);

/// The URL that the gateway has announced in a file; empty if it has not yet.
std::optional<std::string> announced_url(const std::string& path);

}  // namespace dmise
