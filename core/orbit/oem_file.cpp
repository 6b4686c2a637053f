#include "core/orbit/oem_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

constexpr const char* stop_key = "STOP_TIME = ";

}  // namespace

std::string oem_state_line(const std::string& utc, const Vec<Gcrs>& r, const Vec<Gcrs>& v) {
  return utc + formatted(" %.9f %.9f %.9f %.12f %.12f %.12f\n", r.x / km, r.y / km, r.z / km,
                         v.x / km, v.y / km, v.z / km);
}

OemFile::OemFile(std::string path, OemSubject subject)
    : path_(std::move(path)), subject_(std::move(subject)) {}

OemFile::~OemFile() {
  if (file_) std::fclose(file_);
}

void OemFile::fail() const { throw Error(path_ + ": can't be written: " + std::strerror(errno)); }

void OemFile::open(const char* mode) {
  if (file_) std::fclose(file_);
  file_ = std::fopen(path_.c_str(), mode);
  if (!file_) fail();
}

void OemFile::begin() {
  open("w+b");
  held_utc_.clear();
  last_utc_.clear();
  write("CCSDS_OEM_VERS = 2.0\nCREATION_DATE = " + subject_.creation_date +
        "\nORIGINATOR = DMISE\n");
}

void OemFile::keep_before(const std::string& utc) {
  if (!std::filesystem::exists(path_)) return begin();
  const std::string text = read_text_file(path_);
  std::size_t keep = 0, meta = 0, stop = 0;
  std::string last;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line == "META_START") {
      meta = at;
      last.clear();
    }
    if (line.starts_with(stop_key)) stop = at + std::strlen(stop_key);
    const bool is_state = !line.empty() && line[0] >= '0' && line[0] <= '9';
    if (is_state && line.substr(0, utc.size()) >= utc) break;
    if (is_state) last = line.substr(0, utc.size());
    keep = end + 1;
  }
  if (keep == 0) return begin();
  if (last.empty() && meta > 0) keep = meta;  // its last segment is empty
  write_file_whole(path_, text.substr(0, keep));
  open("r+b");
  held_utc_.clear();
  last_utc_ = last;
  stop_at_ = long(stop);
  if (!last.empty()) write(last, stop_at_, SEEK_SET);
}

void OemFile::add(const std::string& utc, const std::string& previous_utc, const Vec<Gcrs>& r,
                  const Vec<Gcrs>& v) {
  const std::string line = oem_state_line(utc, r, v);
  if (!last_utc_.empty() && last_utc_ == previous_utc) {
    write(line);
    write(utc, stop_at_, SEEK_SET);
    last_utc_ = utc;
    return;
  }
  last_utc_.clear();
  if (held_utc_.empty() || held_utc_ != previous_utc) {
    held_utc_ = utc;
    held_line_ = line;
    return;
  }
  std::string text =
      "META_START\nOBJECT_NAME = " + subject_.object_name + "\nOBJECT_ID = " + subject_.object_id +
      "\nCENTER_NAME = EARTH\nREF_FRAME = GCRF\nTIME_SYSTEM = UTC\nSTART_TIME = " + held_utc_ +
      "\n" + stop_key;
  if (std::fseek(file_, 0, SEEK_END) != 0) fail();
  stop_at_ = std::ftell(file_) + long(text.size());
  text += utc + "\nINTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 7\nMETA_STOP\n";
  write(text + held_line_ + line);
  last_utc_ = utc;
  held_utc_.clear();
}

void OemFile::write(const std::string& text, long offset, int from) {
  if (std::fseek(file_, offset, from) != 0 ||
      std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
    fail();
}

}  // namespace dmise
