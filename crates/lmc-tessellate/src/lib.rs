//! Localized marching cubes of any scalar field between given loops, welded to them.
