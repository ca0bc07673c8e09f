# proves: the power cuts do lose data: with WAL and synchronous=NORMAL acknowledged transactions are gone (negative control)
# needs: disk
# timeout: 120
# part of the negative control of disk-wal-full
modprobe virtio_blk ext4
mkdir -p /mnt/data
mount -t ext4 /dev/vda /mnt/data
"$BIN/bench_disk_writer" /mnt/data/station.sqlite NORMAL 150 /out/acknowledged
sync /out/acknowledged
# The disk is left mounted: the power goes now, or at any moment before.
