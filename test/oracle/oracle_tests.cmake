# oracle tests
