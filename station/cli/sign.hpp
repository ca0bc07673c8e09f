#pragma once
#include <string>
#include <vector>

namespace turnpoint::cli {

/// Writes FOLDER/SHA256SUMS over the files (as `sha256sum -c` reads it) and signs it with `ssh-keygen -Y
/// sign`, which writes SHA256SUMS.sig beside it. `key` is an SSH key file, or a public key whose private half
/// is held by an agent; ssh-keygen asks for a passphrase on the terminal. Every file must be inside the
/// folder. Returns the paths of the two files. Throws store::StoreError if a file cannot be read, and
/// std::runtime_error if ssh-keygen fails.
std::vector<std::string> sign_files(const std::string& folder, const std::vector<std::string>& files,
                                    const std::string& key);

}  // namespace turnpoint::cli
