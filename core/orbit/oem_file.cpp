#include "core/orbit/oem_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable_ascii.h"
#include "core/base/units.h"

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
  if (file_) std::fclose(file_);
  file_ = nullptr;
  last_utc_.clear();
  remove_file(path_);
}

void OemFile::keep_before(const std::string& utc) {
  if (!std::filesystem::exists(path_)) return begin();
  const std::string text = read_text_file(path_);
  std::size_t keep = 0, meta = 0, stop = 0;
  std::string last;
  bool any = false;
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
    any = any || is_state;
    keep = end + 1;
  }
  if (!any) return begin();
  if (last.empty()) keep = meta;  // its last segment is empty
  write_file_whole(path_, text.substr(0, keep));
  open("r+b");
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
  std::string text;
  if (!file_) {
    open("w+b");
    text = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = " + subject_.creation_date +
           "\nORIGINATOR = DMISE\n";
  }
  text += "META_START\nOBJECT_NAME = " + printable_ascii(subject_.object_name) +
          "\nOBJECT_ID = " + printable_ascii(subject_.object_id) +
          "\nCENTER_NAME = EARTH\nREF_FRAME = GCRF\nTIME_SYSTEM = UTC\nSTART_TIME = " + utc + "\n" +
          stop_key;
  if (std::fseek(file_, 0, SEEK_END) != 0) fail();
  stop_at_ = std::ftell(file_) + long(text.size());
  write(text + utc + "\nINTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 7\nMETA_STOP\n" + line);
  last_utc_ = utc;
}

void OemFile::write(const std::string& text, long offset, int from) {
  if (std::fseek(file_, offset, from) != 0 ||
      std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
    fail();
}

}  // namespace dmise
