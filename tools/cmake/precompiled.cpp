// Nothing of its own: the target it belongs to carries precompiled headers (LinescopePrecompiled.cmake).
