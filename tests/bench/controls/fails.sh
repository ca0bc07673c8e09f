# proves: nothing; it fails on purpose
# timeout: 60
grep -q "no such text" /proc/version
say "never reached"
