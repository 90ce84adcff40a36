(comment) @comment
(section) @markup.heading
(block_number) @label
(skip) @keyword.modifier
(number) @number
(parameter) @variable
(label_number) @function
(name) @string
(axis) @property
(path_function) @keyword
(compensation) @keyword.modifier
(direction) @keyword.modifier
(m_function) @function.builtin
(feed) @property
(speed) @property
(keyword) @keyword.operator
(operator) @operator
(text) @string.special
(string) @string
(later_function) @keyword
[(begin) (end) (blank) (tool_definition) (tool_call) (label) (call_label) (call_program) (cycle_definition)
 (cycle_call) (probe) (function) (stop) (goto) (repetitions)] @keyword
