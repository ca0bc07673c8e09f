namespace turnpoint::physics { const char* version() { return "0"; } }
