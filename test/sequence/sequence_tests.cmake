# sequence tests
