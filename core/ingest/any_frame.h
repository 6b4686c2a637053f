#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/parallel.h"
#include "core/image/fits_file.h"

namespace dmise {

/// What to read of a file.
struct FrameChoice {
  std::optional<int> plane;                   // place on a third axis, from 1
  std::map<std::string, std::string> stated;  // values that replace those of keywords
};

/// Receives the frames of a file, one after another.
using TakeFrame = std::function<void(const Frame&)>;

/// Reads a FITS file of any camera. A file with this program's own keywords is read by them alone
/// (`decode_frame`). Any other is read by standard ones: pixels of any type, mapped to 16 bits,
/// and what its header says of time, site, pointing and detector. `Frame::notes` and
/// `FrameHeader::unknown` say what it leaves unsaid. Three planes are colours, whose sum is the
/// frame, unless CTYPE3 says otherwise; other numbers of planes are frames. Throws `ConfigError`
/// "NAME: HDU N: KEYWORD: reason, got VALUE".
void decode_frames(std::string_view bytes, const std::string& name, const FrameChoice& choice,
                   Threads& threads, const TakeFrame& take);

/// Reads the frames of a file, optionally gzipped.
void read_frames_of(const std::string& path, const FrameChoice& choice, Threads& threads,
                    const TakeFrame& take);

/// The only frame of a file. Throws `ConfigError` if it holds several and none is chosen.
Frame read_any_frame(const std::string& path, const FrameChoice& choice, Threads& threads);

}  // namespace dmise
