#include "nodes/runtime/keys.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t key_characters = 40;

std::string path_of(const std::string& directory, const std::string& name, const char* ending) {
  if (name.empty() || name.find('/') != std::string::npos)
    throw ConfigError("a key's name must be that of a node, got \"" + name + "\"");
  return directory + "/" + name + ending;
}

/// Writes a new file; nobody else can have opened it before its mode was set.
void write_new(const std::string& path, mode_t mode, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0 && errno == EEXIST) throw ConfigError(path + ": there is such a key already");
  const bool written = file >= 0 && fchmod(file, mode) == 0 &&
                       write(file, text.data(), text.size()) == ssize_t(text.size()) &&
                       fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (!written) throw Error(path + ": can't be written: " + std::strerror(reason));
}

bool is_key(const std::string& text) {
  std::uint8_t bytes[32];
  return text.size() == key_characters && zmq_z85_decode(bytes, text.c_str());
}

/// Value of the line "KEY VALUE"; empty if there is none.
std::string value_in(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  std::string word, value;
  while (file >> word)
    if (word == key && file >> value) return value;
  return "";
}

}  // namespace

void make_key(const std::string& directory, const std::string& name, bool truth) {
  if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
    throw Error(directory + ": can't be made: " + std::strerror(errno));
  char public_key[key_characters + 1], secret_key[key_characters + 1];
  if (zmq_curve_keypair(public_key, secret_key) != 0)
    throw Error("this build of ZeroMQ has no CURVE");
  const std::string open_half = std::string("public ") + public_key + "\n";
  write_new(path_of(directory, name, ".key"), 0600, open_half + "secret " + secret_key + "\n");
  write_new(path_of(directory, name, ".pub"), 0644, open_half + (truth ? "may truth\n" : ""));
}

KeyPair read_key(const std::string& directory, const std::string& name) {
  const std::string path = path_of(directory, name, ".key");
  struct stat status {};
  if (stat(path.c_str(), &status) != 0)
    throw ConfigError(path + ": no such key; dmise keygen " + directory + " " + name + " makes it");
  if (status.st_mode & 077)
    throw ConfigError(path + ": others may read this key; chmod 600 it and make a new one");
  const KeyPair key{value_in(path, "public"), value_in(path, "secret")};
  if (!is_key(key.public_key) || !is_key(key.secret_key))
    throw ConfigError(path + ": not a key of dmise keygen");
  return key;
}

std::map<std::string, AllowedKey> read_allowed(const std::string& directory) {
  std::map<std::string, AllowedKey> allowed;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(directory, ignored)) {
    if (entry.path().extension() != ".pub") continue;
    const std::string path = entry.path().string();
    const std::string key = value_in(path, "public");
    if (is_key(key))
      allowed[key] = {entry.path().stem().string(), key, value_in(path, "may") == "truth"};
  }
  return allowed;
}

std::string public_key_of(const std::string& directory, const std::string& name) {
  const std::string path = path_of(directory, name, ".pub");
  const std::string key = value_in(path, "public");
  if (!is_key(key)) throw ConfigError(path + ": no public key of " + name);
  return key;
}

bool is_loopback(const std::string& address) {
  for (const char* local : {"inproc://", "ipc://", "tcp://[::1]:", "tcp://localhost:"})
    if (address.starts_with(local)) return true;
  if (!address.starts_with("tcp://127.")) return false;
  return address.find_first_not_of("0123456789.", 6) == address.find(':', 6);
}

}  // namespace dmise
