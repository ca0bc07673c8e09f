#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "station/collector/schema.hpp"
#include "station/collector/tables.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::collector {

namespace {

constexpr const char* kCoded = R"sql(
-- These use immutable functions only; otherwise PostgreSQL would call them for each value instead of inlining them.
CREATE OR REPLACE FUNCTION turnpoint.coded(v text) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 't' || octet_length(v)::text || ':' || v END $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v bigint) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 'i' || length(v::text)::text || ':' || v::text END $$;
CREATE OR REPLACE FUNCTION turnpoint.bits(v double precision) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT ('x' || encode(float8send(v), 'hex'))::bit(64)::bigint::text $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v double precision) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 'r' || length(turnpoint.bits(v))::text || ':' || turnpoint.bits(v) END $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v bytea) RETURNS bytea LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:'::bytea ELSE ('b' || octet_length(v)::text || ':')::bytea || v END $$;
)sql";

/// Returns an SQL expression of type bytea: the bytes that store/checksum.cpp hashes for a row, without the
/// newline at their end.
std::string coded_columns(const CollectedTable& table, const std::vector<std::string>& columns,
                          const std::string& alias) {
  std::string expression = "''::bytea", texts;
  const auto flush = [&] {
    if (!texts.empty()) expression += fmt::format("\n    || convert_to({}, 'UTF8')", texts);
    texts.clear();
  };
  for (const auto& name : columns) {
    const auto value = fmt::format("turnpoint.coded({}.{})", alias, quoted(name));
    const bool is_bytes = table.column(name).type == "BLOB";
    if (is_bytes) flush();
    if (is_bytes)
      expression += " || " + value;
    else
      texts += (texts.empty() ? "" : "\n      || ") + value;
  }
  flush();
  return expression;
}

std::string qualified_order(const std::string& order, const CollectedTable& table) {
  std::string list;
  for (std::size_t at = 0; at < order.size();) {
    const auto end = std::min(order.find(',', at), order.size());
    const auto name = order.substr(at, end - at);
    list += (list.empty() ? "t." : ", t.") + quoted(name);
    if (table.column(name).type == "TEXT") list += " COLLATE \"C\"";  // sort by bytes, as SQLite does
    at = end + 1;
  }
  return list;
}

std::string hash_table(const CollectedTable& table) {
  const auto& part = *table.chain;
  return fmt::format(
      "  IF l.{3} <> p.{3} THEN\n"
      "    SELECT string_agg({1}\n    || '\\x0a'::bytea, ''::bytea ORDER BY {2}) INTO part\n"
      "    FROM turnpoint.{0} t WHERE t.session_id = l.session_id AND t.{4} > p.{3} AND t.{4} <= l.{3};\n"
      "    content := content || convert_to('{0}' || E'\\n', 'UTF8') || coalesce(part, ''::bytea);\n"
      "  END IF;\n",
      table.name, coded_columns(table, part.columns, "t"), qualified_order(part.order, table), part.last,
      quoted(part.counter));
}

std::string link_function() {
  const auto provenance = [](const char* table, const char* alias) {
    const auto& it = collected_table(table);
    return coded_columns(it, it.provenance, alias);
  };
  std::string sql = fmt::format(R"sql(
-- The checksum of link l after link p, over the rows that are stored: the rule of station/store/checksum.hpp.
CREATE OR REPLACE FUNCTION turnpoint.link_sha256(p turnpoint.link, l turnpoint.link) RETURNS text
LANGUAGE plpgsql STABLE AS $fn$
DECLARE content bytea; part bytea;
BEGIN
  content := convert_to('turnpoint/{} ' || l.link_index || ' ' || p.sha256 || E'\n' || l.status
    || E'\n' || octet_length(l.status_reason) || ':' || l.status_reason || E'\n', 'UTF8');
  IF l.link_index = 0 THEN
    SELECT content || {} || {} || {} || {} || '\x0a'::bytea INTO content
    FROM turnpoint.session s LEFT JOIN turnpoint.protocol p1 USING (protocol_key)
      LEFT JOIN turnpoint.rig r USING (rig_key) LEFT JOIN turnpoint.calibration c USING (calibration_id)
    WHERE s.session_id = l.session_id;
  END IF;
)sql",
                                store::kSchema, provenance("session", "s"), provenance("protocol", "p1"),
                                provenance("rig", "r"), provenance("calibration", "c"));
  for (const auto& table : collected_tables())
    if (table.chain) sql += hash_table(table);
  return sql + "  RETURN encode(sha256(content), 'hex');\nEND $fn$;\n";
}

}  // namespace

std::string checksum_sql() { return kCoded + link_function(); }

}  // namespace turnpoint::collector
