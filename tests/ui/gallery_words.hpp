#pragma once
#include <map>
#include <string>

namespace turnpoint::ui {

/// Translations of a protocol's English texts into Arabic and Chinese.
struct GalleryWords {
  const char *ar, *zh;
};

inline const std::map<std::string, GalleryWords> gallery_words{
    {"You will feel vibrations of a surface with one finger and answer questions about them. This takes "
     "about 15 minutes. Your answers are stored under a code, without your name. You may stop at any time, "
     "without giving a reason and without any disadvantage. Do you want to take part?",
     {"ستشعر بإصبع واحدة باهتزازات سطح وتجيب عن أسئلة حولها. يستغرق ذلك نحو 15 دقيقة. تُحفظ إجاباتك تحت رمز "
      "دون اسمك. يمكنك التوقف في أي وقت دون ذكر سبب ودون أي ضرر. هل تريد المشاركة؟",
      "您将用一个手指感受一个表面的振动，并回答有关问题。大约需要15分钟。您的回答以代码保存，不含姓名。您可以"
      "随时停止，无需说明理由，也不会有任何不利。您愿意参加吗？"}},
    {"Yes, I take part", {"نعم، أشارك", "是的，我参加"}},
    {"No, I do not", {"لا، لا أشارك", "不，我不参加"}},
    {"Which hand do you write with?", {"بأي يد تكتب؟", "您用哪只手写字？"}},
    {"Both", {"كلتاهما", "两只手"}},
    {"How old are you, in years?", {"كم عمرك بالسنوات؟", "您多少岁？"}},
    {"Press a button, then slide your finger over the surface. You can feel each example as often as you "
     "wish.",
     {"اضغط زرًا ثم مرر إصبعك على السطح. يمكنك أن تشعر بكل مثال قدر ما تشاء.",
      "请按一个按钮，然后用手指在表面上滑动。每个例子您都可以感受任意多次。"}},
    {"This is smooth", {"هذا أملس", "这是光滑的"}},
    {"This is rough", {"هذا خشن", "这是粗糙的"}},
    {"Did the smooth part end left or right of the mark?",
     {"هل انتهى الجزء الأملس يسار العلامة أم يمينها؟", "光滑的部分在标记的左边还是右边结束？"}},
    {"Left", {"يسار", "左"}},
    {"Right", {"يمين", "右"}},
    {"Keep sliding. Did it become smoother or rougher?",
     {"واصل التمرير. هل أصبح أكثر نعومة أم أكثر خشونة؟", "请继续滑动。变得更光滑还是更粗糙？"}},
    {"Smoother", {"أكثر نعومة", "更光滑"}},
    {"Rougher", {"أكثر خشونة", "更粗糙"}},
    {"Which of the three felt different?", {"أي الثلاثة كان مختلفًا؟", "三个当中哪一个不同？"}},
    {"1st", {"الأول", "第一个"}},
    {"2nd", {"الثاني", "第二个"}},
    {"3rd", {"الثالث", "第三个"}},
    {"Was X like A or like B?", {"هل كان X مثل A أم مثل B؟", "X 与 A 相同还是与 B 相同？"}},
    {"Like A", {"مثل A", "与 A 相同"}},
    {"Like B", {"مثل B", "与 B 相同"}},
    {"How smooth does the strip feel?", {"ما مدى نعومة الشريط؟", "这条带子有多光滑？"}},
    {"not smooth at all", {"ليس ناعمًا على الإطلاق", "一点也不光滑"}},
    {"as smooth as can be", {"ناعم إلى أقصى حد", "极其光滑"}},
    {"not at all", {"إطلاقًا", "完全不"}},
    {"medium", {"متوسط", "中等"}},
    {"very", {"جدًا", "非常"}},
    {"a little", {"قليلًا", "有一点"}},
    {"Which number fits its smoothness? Twice as smooth: twice the number.",
     {"ما العدد المناسب لنعومته؟ ضعف النعومة: ضعف العدد.", "哪个数字符合它的光滑程度？光滑一倍，数字加倍。"}},
    {"How sure are you?", {"ما مدى تأكدك؟", "您有多确定？"}},
    {"guessed", {"تخمين", "猜的"}},
    {"not very", {"غير متأكد", "不太确定"}},
    {"quite", {"متأكد إلى حد ما", "比较确定"}},
    {"certain", {"متأكد تمامًا", "完全确定"}},
    {"Which pattern was it?", {"أي نمط كان؟", "是哪一种图案？"}},
    {"Unpredictable vibrations, intermediate roughness ",
     {"اهتزازات غير منتظمة وخشونة متوسطة عند الأطراف ", "整个表面振动不规则而且边缘处感觉有一点粗糙"}},
    {"Pattern ", {"نمط ", "图案 "}},
    {"Too slow", {"بطيء جدًا", "太慢了"}},
    {"Practice", {"تدريب", "练习"}},
    {"Slide one finger to and fro along the strip. Part of it feels smooth. Say on which side of the mark "
     "the smooth "
     "part ends.",
     {"مرر إصبعًا واحدًا ذهابًا وإيابًا على الشريط. جزء منه أملس. قل على أي جانب من العلامة ينتهي الجزء الأملس.",
      "请用一根手指沿着带子来回滑动。其中一部分感觉光滑。请说出光滑的部分在标记的哪一边结束。"}},
    {"Answer as FAST as you can. Some errors are fine.",
     {"أجب بأسرع ما يمكن. لا بأس ببعض الأخطاء.", "请尽快回答。出现一些错误没有关系。"}},
    {"Be as ACCURATE as you can. Take your time.",
     {"كن دقيقًا قدر الإمكان. خذ وقتك.", "请尽量准确。不用着急。"}},
    {"Move the slider until the smooth part ends at the mark.",
     {"حرك المنزلق حتى ينتهي الجزء الأملس عند العلامة.", "请移动滑块，直到光滑的部分在标记处结束。"}},
};

}  // namespace turnpoint::ui
