#include "nodes/runtime/security/keys.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t key_characters = 40;
constexpr std::size_t longest_file = 16 << 20;  // a ring of 100,000 keys

std::string path_of(const std::string& directory, const std::string& name, const char* ending) {
  if (name.empty() || name.find('/') != std::string::npos)
    throw ConfigError("a key's name must be that of a node, got \"" + name + "\"");
  return directory + "/" + name + ending;
}

/// Writes a new file, with its mode set before anybody else can open it.
void write_new(const std::string& path, mode_t mode, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0 && errno == EEXIST) throw ConfigError(path + ": this key exists already");
  const bool written = file >= 0 && fchmod(file, mode) == 0 &&
                       write(file, text.data(), text.size()) == ssize_t(text.size()) &&
                       fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (written) return;
  if (file >= 0) unlink(path.c_str());
  throw Error(path + ": can't be written: " + std::strerror(reason));
}

bool is_key(const std::string& text) {
  std::uint8_t bytes[32];
  return text.size() == key_characters && zmq_z85_decode(bytes, text.c_str());
}

// Words of NAME.pub, each followed by a value.
constexpr const char* may_word = "may";
constexpr const char* speaks_for_word = "speaks-for";

struct Entry : AllowedKey {
  std::string secret_key;  // empty in NAME.pub
};

void require_key(const std::string& path, const char* half, const std::string& key) {
  if (!is_key(key))
    throw ConfigError(path + ": not a key of dmise keygen: its " + half + " key has " +
                      std::to_string(key.size()) + " of " + std::to_string(key_characters) +
                      " characters of Z85");
}

/// Entries of a NAME.key or NAME.pub, or of each "name NAME" in a ring. Throws `ConfigError` for an
/// invalid or incomplete file.
std::vector<Entry> read_entries(const fs::path& path) {
  std::vector<Entry> entries(1);
  entries[0].name = path.stem().string();
  std::istringstream file(read_text_file(path, longest_file));
  std::string word, value;
  bool is_ring = false;
  while (file >> word) {
    if (!(file >> value))
      throw ConfigError(path.string() + ": not a key of dmise keygen: nothing follows \"" +
                        printable(word) + "\"");
    if (word == "name") {
      if (!is_ring) entries.clear();
      is_ring = true;
      entries.emplace_back().name = value;
    }
    if (word == "public") entries.back().public_key = value;
    if (word == "secret") entries.back().secret_key = value;
    if (word == may_word) entries.back().truth = value == "truth";
    if (word == speaks_for_word) entries.back().nodes.insert(value);
  }
  for (const Entry& entry : entries) {
    require_key(path, "public", entry.public_key);
    if (!entry.secret_key.empty()) require_key(path, "secret", entry.secret_key);
  }
  return entries;
}

/// Files of a directory with this suffix, sorted by name.
std::vector<std::string> files_in(const std::string& directory, const std::string& ending) {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (entry.path().extension() == ending) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string text_of(const KeyPair& key) {
  return "public " + key.public_key + "\nsecret " + key.secret_key + "\n";
}

/// Creates a directory that only its owner may use, if it does not exist.
void make_directory(const std::string& directory) {
  if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
    throw Error(directory + ": can't be created: " + std::strerror(errno));
}

/// Text of a public key with its grants.
std::string text_of(const AllowedKey& allowed) {
  std::string text = "public " + allowed.public_key + "\n";
  if (allowed.truth) text += std::string(may_word) + " truth\n";
  for (const auto& node : allowed.nodes) text += std::string(speaks_for_word) + " " + node + "\n";
  return text;
}

/// Throws `ConfigError` for what cannot be the name of a node, and for the clock, its broker and
/// its operator, for which no agent may speak.
void require_node(const std::string& name) {
  const bool word = !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isspace(c) || std::iscntrl(c);
  });
  if (!word) throw ConfigError("\"" + name + "\" can't be the name of a node");
  for (const char* own : {"time-master", "broker", "operator"})
    if (name == own) throw ConfigError("no agent may speak for " + name);
}

/// Mode bits of a file; 0 if it does not exist.
mode_t mode_of(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode : 0;
}

/// Returns the ring that contains a key of `name`, and its entry there. Throws `ConfigError` if
/// none has it and one could not be read.
std::optional<std::pair<std::string, Entry>> ring_of(const std::string& directory,
                                                     const std::string& ending,
                                                     const std::string& name) {
  std::optional<ConfigError> fault;
  for (const auto& ring : files_in(directory, ending)) try {
      for (const auto& entry : read_entries(ring))
        if (entry.name == name) return std::pair(ring, entry);
    } catch (const ConfigError& error) {
      if (!fault) fault = error;
    }
  if (fault) throw ConfigError(*fault);
  return std::nullopt;
}

/// The file with the key pair of `name`, if there is one.
std::optional<std::string> file_of_key(const std::string& directory, const std::string& name) {
  const std::string own = path_of(directory, name, ".key");
  if (mode_of(own)) return own;
  if (auto ring = ring_of(directory, ".keys", name)) return ring->first;
  return std::nullopt;
}

}  // namespace

void make_key(const std::string& directory, const std::string& name, bool truth,
              const std::set<std::string>& nodes) {
  for (const auto& node : nodes) require_node(node);
  make_directory(directory);
  char public_key[key_characters + 1], secret_key[key_characters + 1];
  if (zmq_curve_keypair(public_key, secret_key) != 0)
    throw Error("this build of ZeroMQ has no CURVE");
  const std::string secret = path_of(directory, name, ".key");
  write_new(secret, 0600, text_of(KeyPair{public_key, secret_key}));
  try {
    write_new(path_of(directory, name, ".pub"), 0644,
              text_of(AllowedKey{name, public_key, truth, nodes}));
  } catch (const Error&) {
    unlink(secret.c_str());
    throw;
  }
}

void make_rings(const std::string& directory,
                const std::map<std::string, std::vector<std::string>>& rings) {
  std::map<std::string, std::string> pairs;
  std::string open_halves;
  for (const auto& [ring, names] : rings)
    for (const auto& name : names)
      pairs[ring] += "name " + name + "\n" + text_of(read_key(directory, name));
  for (const auto& [key, owner] : read_allowed(directory))
    open_halves += "name " + owner.name + "\n" + text_of(owner);
  const std::string below = directory + "/rings";
  make_directory(below);
  for (const auto& [ring, text] : pairs) write_new(path_of(below, ring, ".keys"), 0600, text);
  write_new(path_of(below, "everybody", ".pubs"), 0644, open_halves);
}

KeyPair read_key(const std::string& directory, const std::string& name) {
  const auto path = file_of_key(directory, name);
  if (!path)
    throw ConfigError(path_of(directory, name, ".key") + ": no such key; dmise keygen " +
                      directory + " " + name + " makes it");
  if (mode_of(*path) & 077)
    throw ConfigError(*path + ": others may read this key; chmod 600 it and make a new one");
  for (const auto& entry : read_entries(*path))
    if (entry.name == name && is_key(entry.secret_key)) return {entry.public_key, entry.secret_key};
  throw ConfigError(*path + ": not a key of dmise keygen");
}

std::map<std::string, AllowedKey> read_allowed(const std::string& directory,
                                               std::vector<std::string>* left_out) {
  std::map<std::string, AllowedKey> allowed;
  for (const char* ending : {".pubs", ".pub"})
    for (const auto& path : files_in(directory, ending)) try {
        for (const auto& entry : read_entries(path)) allowed[entry.public_key] = entry;
      } catch (const ConfigError& error) {
        if (left_out) left_out->push_back(error.what());
      }
  return allowed;
}

void check_keys(const std::string& directory) {
  for (const char* ending : {".pubs", ".pub"})
    for (const auto& path : files_in(directory, ending)) read_entries(path);
}

std::string public_key_of(const std::string& directory, const std::string& name) {
  if (const std::string own = path_of(directory, name, ".pub"); mode_of(own))
    for (const auto& entry : read_entries(own))
      if (entry.name == name) return entry.public_key;
  if (const auto ring = ring_of(directory, ".pubs", name)) return ring->second.public_key;
  throw ConfigError(path_of(directory, name, ".pub") + ": no public key of " + name);
}

bool is_loopback(const std::string& address) {
  for (const char* local : {"inproc://", "ipc://", "tcp://[::1]:", "tcp://localhost:"})
    if (address.starts_with(local)) return true;
  if (!address.starts_with("tcp://127.")) return false;
  return address.find_first_not_of("0123456789.", 6) == address.find(':', 6);
}

}  // namespace dmise
