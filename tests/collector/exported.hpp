#pragma once
#include <map>
#include <string>

#include "station/store/read.hpp"

/// Exports a database in all formats to a folder. Returns the bytes of each file, by path.
std::map<std::string, std::string> exported(const std::string& database, const std::string& folder,
                                            const turnpoint::store::SessionFilter& filter = {});
