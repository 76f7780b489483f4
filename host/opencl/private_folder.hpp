// Folders of the user's own, to which nobody else can write.
#pragma once

#include <sys/stat.h>

#include <string>

namespace flaunay::host {

/// Makes a folder, and those above it that are missing, for this user alone (mode 0700). Returns an errno, 0
/// if there is something of this name.
int make_private_folder(const std::string& folder);

/// Why others can write to a file or folder: it belongs to another user, or its mode allows it. Empty if they
/// cannot.
std::string who_else_writes(const struct stat& status);

}  // namespace flaunay::host
