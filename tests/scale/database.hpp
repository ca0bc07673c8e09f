#pragma once
#include <string>

/// Makes a database of many sessions of the demo protocol, four sessions a participant, or adds them to one
/// that is there. Rows and checksums are written by the store's own statements, a session a transaction, so
/// that `turnpoint verify` passes. Each trial has two tones, five events and two links, as a session writes
/// them.
void make_database(const std::string& path, int sessions, int trials, const std::string& station = "scale");
