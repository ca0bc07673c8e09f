// While this module is loaded, the loopback sound card is suspended as if the whole machine were. The module
// calls the suspend callbacks of the card's drivers, children first; when it is removed, it calls their
// resume callbacks in the opposite order. (The whole guest cannot be suspended, because the transport of its
// root file system does not resume.)
#include <linux/device.h>
#include <linux/module.h>
#include <linux/platform_device.h>

static struct device *card;

static const struct dev_pm_ops *callbacks_of(struct device *dev)
{
	if (dev->type && dev->type->pm)
		return dev->type->pm;
	if (dev->class && dev->class->pm)
		return dev->class->pm;
	return dev->driver ? dev->driver->pm : NULL;
}

static int sleep_tree(struct device *dev, void *unused)
{
	const struct dev_pm_ops *pm = callbacks_of(dev);
	int error = device_for_each_child(dev, NULL, sleep_tree);

	return error || !pm || !pm->suspend ? error : pm->suspend(dev);
}

static int wake_tree(struct device *dev, void *unused)
{
	const struct dev_pm_ops *pm = callbacks_of(dev);

	if (pm && pm->resume)
		pm->resume(dev);
	return device_for_each_child(dev, NULL, wake_tree);
}

static int __init card_sleep_init(void)
{
	card = bus_find_device_by_name(&platform_bus_type, NULL, "snd_aloop.0");
	return card ? sleep_tree(card, NULL) : -ENODEV;
}

static void __exit card_sleep_exit(void)
{
	wake_tree(card, NULL);
	put_device(card);
}

module_init(card_sleep_init);
module_exit(card_sleep_exit);
MODULE_DESCRIPTION("A sound card's suspend and resume on demand");
MODULE_LICENSE("GPL");
