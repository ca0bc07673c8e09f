#pragma once
#include <string>

namespace turnpoint::collector {

/// Returns the SQL that turns an empty PostgreSQL database into a collector's database, or upgrades the
/// database of an older collector to this version. Run it as a superuser, in that database. Running it again
/// changes nothing.
///
/// - The tables are those of the station's database (collected_tables()), in the schema turnpoint.
/// - Stations call functions and have no right to any table. The functions run as turnpoint_owner.
/// - turnpoint_reader may read all tables and views.
std::string schema_sql();

// The parts of which schema_sql() consists:
std::string functions_sql();  ///< the functions that stations and administrators call
std::string views_sql();      ///< the views for readers
std::string checksum_sql();   ///< the functions that calculate the checksum chain on the server

}  // namespace turnpoint::collector
