"""L01: is this machine ready?"""
