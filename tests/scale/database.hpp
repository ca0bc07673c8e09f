#pragma once
#include <string>

/// Makes a database with many sessions of the demo protocol, four per participant, or adds sessions to an
/// existing one. Rows and checksums are written by the store's own statements, one transaction per session,
/// so that `turnpoint verify` passes. As in a real session, each trial has two tones, five events and two
/// links of the chain of checksums.
void make_database(const std::string& path, int sessions, int trials, const std::string& station = "scale");
