"""The JSON schemas that editors use agree with the shipped files, and refuse files with mistakes that a schema can see.
Usage: validate_schema.py SOURCE_DIR. Exit 77 (skipped) without the modules."""
import json
import pathlib
import sys

try:
    import tomllib

    import jsonschema
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

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
    faults.append("too few files were found")

# The schema must reject unknown keys, unknown words and wrong types. It cannot check names that refer to
# others, or arithmetic.
for name in ["key-unknown", "id-number", "seed-negative", "task-kind", "task-device", "block-feedback", "resume-word",
             "scene-rove-negative", "timing-iti-missing", "factor-no-values", "table-unknown"]:
    if not errors(schema, (root / f"tests/protocol/bad/{name}.toml").read_text()):
        faults.append(f"the schema accepts the mistake of {name}.toml")
if not errors(rig_schema, rigs[0].read_text().replace("thickness_mm", "thicknes_mm")):
    faults.append("the rig schema accepts an unknown key")

print("\n".join(faults) or f"{len(protocols)} protocols and {len(rigs)} rigs fit their schemas")
sys.exit(1 if faults else 0)
