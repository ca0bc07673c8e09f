# proves: nothing; it hangs on purpose
# timeout: 15
sleep 1000
