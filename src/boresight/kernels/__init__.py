"""The compiled hot loops: plain functions of numbers and arrays that know neither robots nor files.

Read them in this order: `trigonometry` and `random` (scalars), `carrying` (a plane handed from link to
link), `sweeping` (the cost of a whole population), `breeding` (one generation of differential evolution),
`evolving` (generations without leaving compiled code).
"""
