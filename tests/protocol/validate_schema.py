"""validate_schema.py SOURCE_DIR: tests the JSON schemas with which editors check protocols and rigs.

The schemas must accept all files in protocols/ and deploy/rigs/, and reject files with mistakes that a schema can
detect.
"""
import json
import pathlib
import sys
import tomllib

import jsonschema

root = pathlib.Path(sys.argv[1])
faults = []


def errors(schema, source):
    return list(jsonschema.Draft202012Validator(schema).iter_errors(tomllib.loads(source)))


def check(schema_path, files):
    schema = json.loads((root / schema_path).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    for path in files:
        for error in errors(schema, path.read_text()):
            faults.append(f"{path}: {error.json_path}: {error.message}")
    return schema


protocols = sorted((root / "protocols").glob("*.toml"))
schema = check("protocols/protocol.schema.json", protocols)
rigs = sorted((root / "deploy/rigs").glob("*.toml"))
rig_schema = check("deploy/rigs/rig.schema.json", rigs)
if len(protocols) < 10 or not rigs:
    faults.append("fewer than 10 protocols, or no rigs, were found")

# The schema must reject unknown keys, unknown words and wrong types. It cannot check whether a name
# refers to something that exists, or whether numbers fit together.
for name in ["key-unknown", "id-number", "seed-negative", "task-kind", "task-device", "block-feedback", "resume-word",
             "scene-rove-negative", "timing-iti-missing", "factor-no-values", "table-unknown"]:
    if not errors(schema, (root / f"tests/protocol/bad/{name}.toml").read_text()):
        faults.append(f"the protocol schema accepts tests/protocol/bad/{name}.toml, which has a mistake")
if not errors(rig_schema, rigs[0].read_text().replace("thickness_mm", "thicknes_mm")):
    faults.append("the rig schema accepts a misspelt key")
manual = (root / "deploy/rigs/README.md").read_text()
cells = rigs[0].read_text() + "\n" + manual[manual.index("[force_cells]\n"):].split("```")[0]
for error in errors(rig_schema, cells):
    faults.append(f"[force_cells] of deploy/rigs/README.md: {error.json_path}: {error.message}")
if not errors(rig_schema, cells.replace("delay_ms", "delay_s")) or not errors(rig_schema, cells.replace("480", "4800")):
    faults.append("the rig schema accepts a mistake in [force_cells]")

print("\n".join(faults) or f"{len(protocols)} protocols and {len(rigs)} rigs fit their schemas")
sys.exit(1 if faults else 0)
