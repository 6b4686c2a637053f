#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

namespace dmise {

/// Access classes of endpoints. A public key without `truth` is refused at truth; without keys,
/// processes that have not joined are refused at `run`, the broker's endpoints for nodes.
enum class Domain { control, data, run, truth };

/// A CURVE key pair, each in Z85 (ZeroMQ RFC 32): 40 characters.
struct KeyPair {
  std::string public_key;
  std::string secret_key;  // empty: only the public key is known
};

/// An authorised participant: NAME.pub in the directory of keys.
struct AllowedKey {
  std::string name;
  std::string public_key;
  bool truth = false;
  std::set<std::string> nodes;  // nodes that an agent may speak for
};

/// Creates NAME.key (mode 0600: both keys) and NAME.pub (public key and grants: "truth", `nodes`
/// that an agent may speak for) in `directory`, which is created with mode 0700 if necessary.
/// Throws `ConfigError` if the key exists already, or if no agent may speak for one of `nodes`;
/// `Error` if it cannot be written.
void make_key(const std::string& directory, const std::string& name, bool truth,
              const std::set<std::string>& nodes = {});

// Rings are files of many keys, for processes that receive files instead of a directory
// (containers): in a directory of keys, X.keys counts as the NAME.key and X.pubs as the NAME.pub of
// each "name NAME" in it.

/// Writes rings/RING.keys (mode 0600) with the pairs of the names of each of `rings`, and
/// rings/everybody.pubs with all NAME.pub. Throws as `make_key` and `read_key` do.
void make_rings(const std::string& directory,
                const std::map<std::string, std::vector<std::string>>& rings);

/// Reads NAME.key. Throws `ConfigError` if it is missing, invalid, or readable by others.
KeyPair read_key(const std::string& directory, const std::string& name);

/// Reads all NAME.pub of a directory, by public key. Invalid files are skipped, so their owners are
/// refused; `left_out` receives the reasons if given.
std::map<std::string, AllowedKey> read_allowed(const std::string& directory,
                                               std::vector<std::string>* left_out = nullptr);

/// Throws `ConfigError` with file and reason for the first NAME.pub or ring that is incomplete,
/// unreadable or not a regular file. Never blocks on a writer.
void check_keys(const std::string& directory);

/// The public key of `name`. Throws `ConfigError` if there is none.
std::string public_key_of(const std::string& directory, const std::string& name);

/// Whether an address is reachable only from this machine: "tcp://127.x.y.z:PORT",
/// "tcp://[::1]:PORT", "tcp://localhost:PORT", "ipc://", "inproc://".
bool is_loopback(const std::string& address);

}  // namespace dmise
