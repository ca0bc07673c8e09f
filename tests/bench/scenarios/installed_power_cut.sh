# proves: a session keeps each committed trial through a power cut at any moment, and `turnpoint resume` completes it
# needs: disk
# timeout: 400
disk_begin
mkdir /run/disk/data
watch_rows /run/disk/data/station.sqlite trial /dev/vda & watcher=$!
turnpoint run "$SOURCE/protocols/demo.toml" --rig "$SOURCE/deploy/rigs/simulated.toml" --participant P01 \
  --db /run/disk/data/station.sqlite --headless --observer sim --seed 1 --json >summary.json
cat summary.json
sleep 0.1
kill $watcher
mkdir "$OUT/whole"; cp /run/disk/data/* "$OUT/whole/"
